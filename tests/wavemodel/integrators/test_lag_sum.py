import numpy as np
import pytest

from wavemodel.integrators.lag_sum import LagSum, slopes

LAW = LagSum(0.5, np.array([0.3, -0.2]), np.array([0.1, 2.0]), rate=0.05)


def test_a_step_comes_at_once_and_then_through_the_lags():
    time = np.array([0.0, 0.05, 1.0, 50.0])
    out, _ = LAW.follow(np.diff(time, prepend=0.0), np.ones(4), LAW.rest(0.0))
    expected = 0.5 + 0.3 * (1 - np.exp(-time / 0.1)) - 0.2 * (1 - np.exp(-time / 2.0))
    np.testing.assert_allclose(out, expected, rtol=1e-12)
    assert LAW.static == pytest.approx(0.6)


def test_goes_on_where_it_stopped():
    rng = np.random.default_rng(0)
    durations, values = rng.uniform(0.0, 0.5, 40), rng.normal(size=40)
    whole, _ = LAW.follow(durations, values)
    first, memory = LAW.follow(durations[:17], values[:17])
    second, _ = LAW.follow(durations[17:], values[17:], memory)
    np.testing.assert_allclose(np.concatenate([first, second]), whole, rtol=1e-11, atol=1e-13)


def test_having_been_there_for_ever_is_static():
    out, _ = LAW.follow(np.ones(3), np.full(3, 2.0), LAW.rest(2.0))
    np.testing.assert_allclose(out, 1.2, rtol=1e-13)


def test_a_slope_needs_a_duration():
    np.testing.assert_allclose(slopes(np.array([0.0, 2.0]), np.array([1.0, 2.0]), 0.0), [0.0, 0.5])
