"""Limits of agreement and concordance against published examples and closed forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.comparison import bland_altman, concordance


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


def test_small_sample_by_hand():
    # moments with divisor n: variances 2/3 and 2/3, covariance 2/3, shift 1: 2 (2/3) / (4/3 + 1) = 4/7
    result = concordance([1.0, 2.0, 3.0], [2.0, 3.0, 4.0])
    assert result.coefficient == pytest.approx(4.0 / 7.0, rel=1e-14)
    assert result.correlation == pytest.approx(1.0)
    assert result.bias_correction == pytest.approx(4.0 / 7.0)


def test_peak_flow_by_the_defining_sum(peak_flow):
    large, mini = peak_flow
    spread = np.mean((large - mini) ** 2)
    apart = large.var() + mini.var() + (large.mean() - mini.mean()) ** 2
    result = concordance(large, mini)
    assert result.coefficient == pytest.approx(1.0 - spread / apart, rel=1e-12)
    assert result.coefficient == pytest.approx(result.correlation * result.bias_correction, rel=1e-12)
    assert result.ci95_low < result.coefficient < result.ci95_high


def test_interval_is_that_of_fisher_where_there_is_no_bias():
    # equal means and variances: the coefficient is r and its interval Fisher's with n - 2 in place of n - 3
    first = np.array([1.0, -1.0, 1.0, -1.0, 2.0, -2.0, 0.5, -0.5])
    second = np.array([1.0, -1.0, 2.0, -2.0, 1.0, -1.0, 0.5, -0.5])
    result = concordance(first, second)
    r = np.corrcoef(first, second)[0, 1]
    half = 1.959963984540054 / np.sqrt(6)
    assert result.ci95_low == pytest.approx(np.tanh(np.arctanh(r) - half), rel=1e-12)
    assert result.ci95_high == pytest.approx(np.tanh(np.arctanh(r) + half), rel=1e-12)


def test_interval_covers_the_true_value_with_bias():
    generator, hits = np.random.default_rng(2), 0
    truth = 2 * 0.9 * 1.2 / (1.0 + 1.2**2 + 0.4**2)
    for _ in range(1500):
        first = generator.normal(size=60)
        second = 0.4 + 1.2 * (0.9 * first + np.sqrt(1 - 0.81) * generator.normal(size=60))
        result = concordance(first, second)
        hits += result.ci95_low <= truth <= result.ci95_high
    assert 0.93 <= hits / 1500 <= 0.97


def test_equal_pairs_are_one_and_a_constant_has_none(triangle):
    same = concordance(triangle, triangle)
    assert (same.coefficient, same.ci95_low, same.ci95_high) == (1.0, 1.0, 1.0)
    constant = concordance(triangle, np.full(100, 0.05))
    assert np.isnan(constant.coefficient)
    assert "constant" in constant.note


@given(st.integers(0, 200), st.floats(-16.0, -5.0), st.integers(0, 2))
def test_pairs_that_are_nearly_equal_have_an_interval_round_the_coefficient(seed, digits, kind):
    generator = np.random.default_rng(seed)
    first = generator.uniform(0.0, 3e-3, size=40)
    off = 10.0**digits * (generator.normal(size=40) if kind == 0 else 1.0)
    second = first + 1e-3 * off if kind == 1 else first * (1.0 + off)
    result = concordance(first, second)
    assert result.ci95_low <= result.coefficient <= result.ci95_high <= 1.0
    assert result.coefficient > 1.0 - 1e-7


def test_without_correlation_there_is_no_interval():
    result = concordance([1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0])
    assert result.coefficient == 0.0
    assert np.isnan(result.ci95_low)
    assert result.note


def test_a_proportional_wave_has_an_interval(triangle):
    result = concordance(triangle, 1.1 * triangle)
    assert result.ci95_low < result.coefficient < result.ci95_high < 1.0


@given(st.integers(0, 200), st.floats(0.01, 100.0), st.floats(-5.0, 5.0))
def test_symmetric_and_free_of_scale_and_origin(seed, scale, origin):
    generator = np.random.default_rng(seed)
    first = generator.normal(size=9)
    second = first + 0.5 * generator.normal(size=9)
    value = concordance(first, second).coefficient
    assert concordance(second, first).coefficient == pytest.approx(value, rel=1e-12)
    moved = concordance(scale * (first + origin), scale * (second + origin)).coefficient
    assert moved == pytest.approx(value, rel=1e-9)
    assert -1.0 <= value <= 1.0
