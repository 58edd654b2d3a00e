import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.comparison import bland_altman


def test_published_peak_flow_example(peak_flow):
    large, mini = peak_flow
    result = bland_altman(mini, large)  # large minus mini, as printed: -2.1, 38.8, interval -22.0 to 17.8
    assert result.bias == pytest.approx(-2.1, abs=0.05)
    assert result.std == pytest.approx(38.8, abs=0.05)
    assert result.bias_ci95 == (pytest.approx(-22.0, abs=0.1), pytest.approx(17.8, abs=0.1))
    assert result.lower == pytest.approx(-2.1176 - 1.959964 * 38.7651, abs=1e-3)
    assert result.upper == pytest.approx(-2.1176 + 1.959964 * 38.7651, abs=1e-3)


def test_limits_are_wider_than_the_bias_interval(peak_flow):
    result = bland_altman(*peak_flow)
    n, z = 17, 1.959963984540054
    ratio = np.sqrt(1 / n + z**2 / (2 * (n - 1))) * np.sqrt(n)
    of_bias, of_limit = np.ptp(result.bias_ci95), np.ptp(result.upper_ci95)
    assert of_limit / of_bias == pytest.approx(ratio, rel=1e-12)
    assert np.ptp(result.lower_ci95) == pytest.approx(of_limit)


def test_limit_interval_covers_the_true_limit():
    generator = np.random.default_rng(5)
    hits = 0
    for _ in range(2000):
        result = bland_altman(np.zeros(30), generator.normal(0.3, 2.0, 30))
        hits += result.upper_ci95[0] <= 0.3 + 1.959964 * 2.0 <= result.upper_ci95[1]
    assert 0.93 <= hits / 2000 <= 0.97


def test_equal_samples_have_limits_at_zero(triangle):
    result = bland_altman(triangle, triangle)
    assert (result.bias, result.lower, result.upper) == (0.0, 0.0, 0.0)
    assert len(result.rows()) == 10


@given(st.integers(0, 100), st.floats(0.01, 100.0))
def test_swapping_turns_the_sign_and_scaling_scales(seed, scale):
    generator = np.random.default_rng(seed)
    first, second = generator.normal(size=10), generator.normal(size=10)
    result, swapped = bland_altman(first, second), bland_altman(second, first)
    assert swapped.bias == pytest.approx(-result.bias)
    assert swapped.lower == pytest.approx(-result.upper)
    assert bland_altman(scale * first, scale * second).upper == pytest.approx(scale * result.upper, rel=1e-9)
