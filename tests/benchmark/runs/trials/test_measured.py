"""The peak of a record is not the largest of its noise, and is not cut where it is sharp."""

import numpy as np
import pytest

from benchmark.runs.trials.measured import peak_force, peak_weights

PEAK = 0.336


def press(time: np.ndarray, *corners: float) -> np.ndarray:
    """Force (n,) N at the depth that rises and falls between corners (s): up, held, down."""
    depth = np.interp(time, corners, [0.0, *[1.0] * (len(corners) - 2), 0.0])
    return PEAK * depth**1.3


def told(true: np.ndarray, noise: float, draws: int = 100) -> tuple[np.ndarray, np.ndarray]:
    """Of noisy records: error (draws,) N of the peak, and of a right model's at the same rows beside it."""
    random, time = np.random.default_rng(3), np.arange(true.size) / 20.0
    peaks, apart = [], []
    for _ in range(draws):
        record = true + random.normal(0.0, noise, true.size)
        rule = peak_weights(time, record)
        peaks.append(rule @ record - true.max())
        apart.append(rule @ (record - true))
    return np.array(peaks), np.array(apart)


def test_the_peak_of_a_noisy_hold_is_that_of_its_force() -> None:
    """The largest of 200 rows lay 2.75 standard deviations of the noise above: a right model was 7 u_val off."""
    peaks, apart = told(press(np.arange(401) / 20.0, 0.0, 5.0, 15.0, 20.0), 5e-3)
    assert abs(apart.mean()) < 0.1 * 5e-3
    assert abs(peaks.mean()) < 0.1 * 5e-3
    assert apart.std() < 0.25 * 5e-3


@pytest.mark.parametrize("noise", [5e-4, 5e-3, 2e-2])
def test_a_sharp_peak_is_neither_cut_nor_raised_by_noise(noise: float) -> None:
    """A mean over the rows within the noise would be three standard deviations low."""
    peaks, apart = told(press(np.arange(201) / 20.0, 0.0, 5.0, 10.0), noise)
    assert abs(apart.mean()) < 0.3 * noise
    assert abs(peaks.mean()) < 0.4 * noise


@pytest.mark.parametrize("corners", [(0.0, 5.0, 10.0), (0.0, 2.0, 10.0), (0.0, 2.0, 8.0, 10.0), (0.0, 10.0, 20.0)])
def test_without_noise_the_peak_is_the_largest_row(corners: tuple[float, ...]) -> None:
    time = np.arange(201) / 20.0
    force = press(time, *corners)
    assert peak_force(time, force) == pytest.approx(force.max(), rel=1e-9)


def test_a_peak_that_relaxes_at_once_is_fitted_where_it_begins() -> None:
    time = np.arange(401) / 20.0
    memory = np.where(time > 5.0, 0.8 + 0.2 * np.exp(-(time - 5.0) / 1.5), 1.0)
    peaks, apart = told(memory * press(time, 0.0, 5.0, 15.0, 20.0), 3e-3)
    assert abs(apart.mean()) < 0.2 * 3e-3
    assert abs(peaks.mean()) < 0.5 * 3e-3


@pytest.mark.parametrize("rows", [1, 2, 3, 4])
def test_a_record_of_few_rows_has_its_largest(rows: int) -> None:
    force = np.array([0.1, 0.4, 0.2, 0.3])[:rows]
    assert peak_force(np.arange(rows) / 10.0, force) == force.max()
