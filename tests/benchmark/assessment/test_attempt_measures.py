"""Measures of motion against cases worked by hand, and against figures of the authors of two of them."""

from itertools import pairwise

import numpy as np
import pytest

from benchmark.assessment.attempt_measures import (
    Attempt,
    bimanual_correlation,
    economy_of_motion,
    log_dimensionless_jerk,
    motion_frequency,
    path_length,
    root_mean_square,
    spectral_arc_length,
    speed_of,
    tremor,
)

EXACT = {"rel": 1e-9, "abs": 1e-15}


def test_a_path_by_hand():
    position = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [3.0, 4.0, 12.0]])
    assert path_length(position) == pytest.approx(17.0, **EXACT)
    np.testing.assert_allclose(speed_of(position, 10.0), [50.0, 120.0], rtol=1e-15)


def test_economy_by_hand():
    position = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]])
    assert economy_of_motion(position, position[-1:]) == pytest.approx(5.0 / 7.0, **EXACT)
    assert economy_of_motion(position, position[1:]) == pytest.approx(1.0, **EXACT)
    assert np.isnan(economy_of_motion(np.zeros((3, 3)), np.ones((1, 3))))


GAUSSIAN = np.exp(-5.0 * np.arange(-1.0, 1.0, 0.01) ** 2)


def test_smoothness_has_its_authors_own_figures():
    """The examples in the program that Balasubramanian et al. published with their article."""
    assert f"{spectral_arc_length(GAUSSIAN, 100.0):.5f}" == "-1.41403"
    assert f"{log_dimensionless_jerk(GAUSSIAN, 100.0):.5f}" == "-5.81636"


def test_jerk_by_hand():
    count, rate = 50, 20.0
    speed = (np.arange(count) / rate) ** 2
    whole = (count / rate) ** 3 * 4.0 * (count - 2) / rate
    expected = -np.log(whole / ((count - 1) / rate) ** 4)
    assert log_dimensionless_jerk(speed, rate) == pytest.approx(expected, **EXACT)
    assert np.isnan(log_dimensionless_jerk(np.zeros(9), rate))


def test_smoothness_does_not_depend_on_size_or_pace():
    for measure in (log_dimensionless_jerk, spectral_arc_length):
        assert measure(7.0 * GAUSSIAN, 100.0) == pytest.approx(measure(GAUSSIAN, 100.0), rel=1e-9)
    assert log_dimensionless_jerk(GAUSSIAN, 50.0) == pytest.approx(log_dimensionless_jerk(GAUSSIAN, 100.0), rel=1e-9)


def test_an_arc_by_hand():
    """The spectrum of one sample among none is flat: the curve is a straight line of length one."""
    speed = np.zeros(64)
    speed[0] = 3.0
    assert spectral_arc_length(speed, 20.0) == pytest.approx(-1.0, **EXACT)
    assert np.isnan(spectral_arc_length(np.zeros(64), 20.0))


def test_more_stops_are_less_smooth():
    thrice = np.concatenate([GAUSSIAN] * 3)
    assert spectral_arc_length(thrice, 100.0) < spectral_arc_length(GAUSSIAN, 100.0)
    assert log_dimensionless_jerk(thrice, 100.0) < log_dimensionless_jerk(GAUSSIAN, 100.0)


def waves(count, rate, **parts):
    """Positions (count + 1, 3) along x: sines of whole periods within `count` samples, by "fHz" amplitude."""
    time = np.arange(count + 1) / rate
    x = sum(amplitude * np.sin(2.0 * np.pi * float(name[1:]) * time) for name, amplitude in parts.items())
    return np.column_stack([x, np.zeros(time.size), np.zeros(time.size)])


def test_the_motion_frequency_of_sines():
    assert motion_frequency(waves(500, 100.0, f2=1.0), 100.0) == pytest.approx(2.0, **EXACT)
    slow = waves(500, 100.0, f2=1.0, f8=0.05)  # power of speed 4 % at 8 Hz
    shaken = waves(500, 100.0, f2=1.0, f8=0.08)  # 9 %
    assert motion_frequency(slow, 100.0) == pytest.approx(2.0, **EXACT)
    assert motion_frequency(shaken, 100.0) == pytest.approx(8.0, **EXACT)
    assert np.isnan(motion_frequency(np.ones((50, 3)), 100.0))


def test_tremor_is_the_effective_value_within_its_band():
    position = waves(500, 100.0, f1=20e-3, f10=3e-5)[:-1]
    assert tremor(position, 100.0) == pytest.approx(3e-5 / np.sqrt(2.0), rel=1e-9)
    assert tremor(waves(500, 100.0, f1=20e-3, f14=3e-5)[:-1], 100.0) < 1e-15


def test_hands_together_by_hand():
    first = np.array([1.0, 2.0, 3.0, 2.0])
    assert bimanual_correlation(first, 2.0 * first + 1.0) == pytest.approx(1.0, **EXACT)
    assert bimanual_correlation(first, -first) == pytest.approx(-1.0, **EXACT)
    other = np.array([1.0, 0.0, 0.0, 1.0])
    assert bimanual_correlation(first, other) == pytest.approx(-1.0 / np.sqrt(2.0), **EXACT)
    assert np.isnan(bimanual_correlation(first, np.ones(4)))


def test_accuracy_by_hand():
    assert root_mean_square(np.array([3.0, -4.0])) == pytest.approx(np.sqrt(12.5), **EXACT)
    assert np.isnan(root_mean_square(np.empty(0)))


def test_an_attempt_by_hand():
    """A tool straight to two targets: 40 mm across, 2.5 mm down, up, 30 mm along, 2.8 mm down; 51 samples each way."""
    ways = [(0, 0, 0), (40, 0, 0), (40, 0, 2.5), (40, 0, 0), (40, 30, 0), (40, 30, 2.8)]
    share = np.linspace(0.0, 1.0, 52)[1:, None]
    pieces = [1e-3 * (np.array(a) + share * np.subtract(b, a)) for a, b in pairwise(ways)]
    position = np.vstack([np.zeros((1, 3)), *pieces])
    force = np.where(position[:, 1] < 1e-3, 1.0, 2.0) * (position[:, 2] > 0.0)
    target = 1e-3 * np.array([[41.0, 0.0, 2.0], [40.0, 29.0, 3.0]])
    wanted = np.array([1.2, 1.9])
    time = 0.01 * np.arange(len(position))
    found = Attempt("one", "", time, {0: position}, {0: force}, target, wanted).measures()
    assert found["time_s"] == pytest.approx(2.55, **EXACT)
    assert found["path_length_mm"] == pytest.approx(40.0 + 2.5 + 2.5 + 30.0 + 2.8, **EXACT)
    straight = np.sqrt(41.0**2 + 2.0**2) + np.sqrt(1.0 + 29.0**2 + 1.0)
    assert found["economy_of_motion"] == pytest.approx(straight / 77.8, **EXACT)
    assert found["depth_error_mm"] == pytest.approx(np.sqrt((0.5**2 + 0.2**2) / 2.0), **EXACT)
    assert found["force_error_N"] == pytest.approx(np.sqrt((0.2**2 + 0.1**2) / 2.0), **EXACT)
    both = Attempt("two", "", time, {0: position, 1: position}, {0: force, 1: force}, target, wanted).measures()
    assert both["path_length_mm"] == pytest.approx(2.0 * 77.8, **EXACT)
    assert both["bimanual_correlation"] == pytest.approx(1.0, **EXACT)
