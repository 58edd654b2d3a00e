"""Fitted normals, their overlap and the area metric against hand computation, SciPy and statsmodels."""

import math

import numpy as np
import pytest
import scipy
from statsmodels.stats.diagnostic import normal_ad

from benchmark.comparison import ComparisonError, area_metric, normal_fit, overlap


def test_mean_std_and_anderson_darling(triangle):
    fit = normal_fit(triangle)
    statistic, p_value = normal_ad(triangle)
    assert (fit.mean, fit.std, fit.n) == (pytest.approx(0.05508), pytest.approx(triangle.std(ddof=1)), 100)
    assert fit.anderson_darling == pytest.approx(statistic, rel=1e-12)
    assert fit.p_value == pytest.approx(p_value, rel=1e-12)
    assert fit.p_value < 0.05  # a load triangle is not normal


def test_anderson_darling_by_its_definition():
    sample = np.sort(np.random.default_rng(1).normal(3.0, 2.0, 25))
    z = scipy.stats.norm.cdf((sample - sample.mean()) / sample.std(ddof=1))
    i = np.arange(1, 26)
    expected = -25 - np.mean((2 * i - 1) * (np.log(z) + np.log(1 - z[::-1])))
    assert normal_fit(sample).anderson_darling == pytest.approx(expected, rel=1e-12)


def test_p_is_uniform_where_the_sample_is_normal():
    generator = np.random.default_rng(6)
    low = np.mean([normal_fit(generator.normal(size=40)).p_value < 0.05 for _ in range(1000)])
    assert 0.03 <= low <= 0.07


def test_a_constant_sample_says_so():
    fit = normal_fit([2.0, 2.0, 2.0])
    assert fit.std == 0.0
    assert math.isnan(fit.p_value)
    assert "constant" in fit.note


def test_a_far_outlier_is_not_normal():
    fit = normal_fit(np.append(np.random.default_rng(0).normal(size=3000), 500.0))
    assert fit.p_value == 0.0


def test_overlap_of_equal_spread_by_hand():
    # two normals d apart with one s overlap by 2 Phi(-d / 2s)
    first, second = normal_fit([-1.0, 0.0, 1.0]), normal_fit([0.5, 1.5, 2.5])
    assert overlap(first, second) == pytest.approx(2 * scipy.stats.norm.cdf(-0.75), rel=1e-12)
    assert overlap(second, first) == overlap(first, second)
    assert overlap(first, first) == 1.0


def test_overlap_by_quadrature():
    first, second = normal_fit([0.0, 1.0, 2.0]), normal_fit([0.0, 4.0, 8.0])
    x = np.linspace(-20, 30, 400001)
    lower = np.minimum(scipy.stats.norm.pdf(x, 1, 1), scipy.stats.norm.pdf(x, 4, 4))
    assert overlap(first, second) == pytest.approx(np.trapezoid(lower, x), rel=1e-6)


def test_overlap_of_point_masses():
    point, other, spread = normal_fit([1.0, 1.0, 1.0]), normal_fit([2.0, 2.0, 2.0]), normal_fit([0.0, 1.0, 2.0])
    assert overlap(point, point) == 1.0
    assert overlap(point, other) == 0.0
    assert overlap(point, spread) == 0.0


def test_two_values_are_too_few():
    with pytest.raises(ComparisonError, match="at least 3"):
        normal_fit([1.0, 2.0])


def test_two_steps_by_hand() -> None:
    # reference at 1 and 3, model at 2 and 6: |F| differs by 1/2 on (1, 2) and on (3, 6)
    found = area_metric([1.0, 3.0], [2.0, 6.0])
    assert found.area == pytest.approx(0.5 * 1.0 + 0.5 * 3.0, abs=1e-15)
    assert found.above == pytest.approx(2.0, abs=1e-15)
    assert found.below == 0.0


def test_crossing_distributions_split_into_both_sides() -> None:
    found = area_metric([0.0, 4.0], [1.0, 3.0])
    assert (found.area, found.above, found.below) == pytest.approx((1.0, 0.5, 0.5), abs=1e-15)


def test_a_shift_is_its_own_area_and_parts_add_up() -> None:
    generator = np.random.default_rng(3)
    sample, other = generator.normal(size=37), generator.normal(0.4, 1.3, size=52)
    assert area_metric(sample, sample + 0.25).area == pytest.approx(0.25, abs=1e-12)
    found = area_metric(sample, other)
    assert found.area == pytest.approx(scipy.stats.wasserstein_distance(sample, other), abs=1e-12)
    assert found.above + found.below == pytest.approx(found.area, abs=1e-12)


def test_gaps_are_left_out_and_nothing_is_refused() -> None:
    assert area_metric([1.0, np.nan], [1.0]).area == 0.0
    with pytest.raises(ComparisonError, match="common rows"):
        area_metric([np.nan], [1.0])
