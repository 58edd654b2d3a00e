"""Two-sample and paired t-tests against the paper's Table 2 and SciPy; what the pooled one lets pass."""

import math

import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from statsmodels.stats.power import TTestIndPower
from statsmodels.stats.weightstats import ttest_ind

from benchmark.comparison import (
    ComparisonError,
    paired_t_test,
    passing_scale_errors,
    pooled_t_test,
    t_test_power,
    welch_t_test,
)


def test_table_2_of_the_paper(triangle):
    test = pooled_t_test(triangle, triangle)
    assert test.fem.mean == pytest.approx(0.05508, rel=1e-12)
    assert test.fem.variance == pytest.approx(0.0010223, abs=5e-9)
    assert test.fem.observations == 100
    assert test.t_critical == pytest.approx(1.972017, abs=5e-7)
    assert (test.df, test.t, test.p_value) == (198, 0.0, 1.0)


def test_printed_t_gives_the_printed_p(triangle):
    shift = 0.00355 * np.sqrt(2 * np.var(triangle, ddof=1) / 100)
    test = pooled_t_test(triangle, triangle - shift)
    assert test.t == pytest.approx(0.00355, rel=1e-9)
    assert test.p_value == pytest.approx(0.997171, abs=5e-7)
    assert shift == pytest.approx(1.605e-5, rel=1e-3)


def test_small_sample_by_hand():
    # means 3 and 5, both variances 1, pooled standard error sqrt(2/3)
    test = pooled_t_test([2.0, 3.0, 4.0], [4.0, 5.0, 6.0])
    assert test.t == pytest.approx(-2.0 / np.sqrt(2.0 / 3.0), rel=1e-14)
    assert test.df == 4
    assert test.difference == pytest.approx(2.0)
    assert test.ci95_high - test.difference == pytest.approx(2.776445105 * np.sqrt(2.0 / 3.0), rel=1e-9)


@pytest.mark.parametrize(("ours", "usevar"), [(pooled_t_test, "pooled"), (welch_t_test, "unequal")])
@pytest.mark.parametrize("hypothesis", [0.0, 0.3])
def test_same_as_statsmodels(ours, usevar, hypothesis):
    generator = np.random.default_rng(3)
    first, second = generator.normal(1.0, 0.2, 40), generator.normal(0.8, 0.9, 40)
    test = ours(first, second, hypothesis)
    t, p, df = ttest_ind(first, second, usevar=usevar, value=hypothesis)
    assert (test.t, test.p_value, test.df) == (
        pytest.approx(t, rel=1e-12),
        pytest.approx(p, rel=1e-12),
        pytest.approx(df, rel=1e-12),
    )


def test_interval_belongs_to_the_test():
    generator = np.random.default_rng(4)
    first, second = generator.normal(size=30), generator.normal(0.4, 1.0, 30)
    for test in (pooled_t_test(first, second), pooled_t_test(first, second, 0.2), welch_t_test(first, second)):
        at_the_edge = -test.ci95_low  # mean(fem) - mean(wave) at which p is exactly 5 %
        edge = scipy.stats.ttest_ind(first - at_the_edge, second, equal_var=test.form == "pooled")
        assert edge.pvalue == pytest.approx(0.05, rel=1e-9)
        assert test.ci95_low < test.difference < test.ci95_high


def test_rows_are_those_of_table_2(triangle):
    names = [row[0] for row in pooled_t_test(triangle, triangle).rows()]
    assert names == [
        "mean",
        "variance",
        "observations",
        "hypothesized mean difference",
        "df",
        "t",
        "p two-tail",
        "t critical",
    ]


@pytest.mark.parametrize("test", [pooled_t_test, welch_t_test])
@pytest.mark.parametrize("wave", [2.0, 3.0])
def test_constant_samples_have_no_t_and_say_so(test, wave):
    result = test(np.full(10, 2.0), np.full(10, wave))
    assert np.isnan(result.t)
    assert np.isnan(result.p_value)
    assert result.to_dict()["p_value"] is None
    assert not result.rejects
    assert "not defined" in result.note
    assert result.difference == wave - 2.0


def test_rows_with_a_gap_count_for_neither(triangle):
    wave = 1.01 * triangle
    wave[:10] = np.nan
    assert pooled_t_test(triangle, wave) == pooled_t_test(triangle[10:], wave[10:])


@pytest.mark.parametrize(
    ("fem", "wave", "found"),
    [
        ([1.0, 2.0], [1.0], "shape"),
        ([[1.0, 2.0]], [[1.0, 2.0]], "dimension"),
        ([1.0, np.nan], [1.0, 2.0], "1 common rows of 2"),
        ([1.0, np.inf], [1.0, 2.0], r"fem\[1\] is infinite"),
    ],
)
def test_unusable_samples_are_refused(fem, wave, found):
    with pytest.raises(ComparisonError, match=found):
        pooled_t_test(fem, wave)


samples = arrays(float, 12, elements=st.floats(-1e3, 1e3, width=32), unique=True)


@given(samples, samples, st.floats(0.01, 100.0))
def test_symmetric_and_free_of_scale(first, second, scale):
    test, swapped = pooled_t_test(first, second), pooled_t_test(second, first)
    scaled = pooled_t_test(scale * first, scale * second)
    assert swapped.t == pytest.approx(-test.t, rel=1e-9, abs=1e-12)
    assert swapped.p_value == pytest.approx(test.p_value, rel=1e-9)
    assert scaled.t == pytest.approx(test.t, rel=1e-6, abs=1e-9)
    assert scaled.difference == pytest.approx(scale * test.difference, rel=1e-6, abs=1e-9 * scale)


def test_differences_of_a_published_example():
    # Student's sleep data (Biometrika 6:1, 1908): extra hours under two drugs, mean difference 1.58, t = 4.0621
    first = np.array([0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0])
    second = np.array([1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4])
    test = paired_t_test(first, second)
    assert test.difference == pytest.approx(1.58)
    assert test.t == pytest.approx(4.0621, abs=5e-5)
    assert test.p_value == pytest.approx(0.002833, abs=5e-7)
    assert (test.ci95_low, test.ci95_high) == (pytest.approx(0.7001142, abs=5e-8), pytest.approx(2.4598858, abs=5e-8))
    assert (test.observations, test.df) == (10, 9)


def test_same_as_scipy(triangle):
    wave = 1.02 * triangle + 1e-4 * np.sin(np.arange(100))
    test, reference = paired_t_test(triangle, wave), scipy.stats.ttest_rel(wave, triangle)
    assert test.t == pytest.approx(reference.statistic, rel=1e-12)
    assert test.p_value == pytest.approx(reference.pvalue, rel=1e-12)


@pytest.mark.parametrize("shift", [0.0, 0.25])
def test_differences_without_spread_have_no_t_and_say_so(triangle, shift):
    test = paired_t_test(triangle, triangle + shift)
    assert np.isnan(test.t)
    assert "do not vary" in test.note
    assert test.ci95_low == test.ci95_high == pytest.approx(shift)


def test_rows_carry_the_interval(triangle):
    test = paired_t_test(triangle, 1.1 * triangle)
    values = {row[0]: row[3] for row in test.rows()}
    assert values["difference ci95 low"] < values["mean difference"] < values["difference ci95 high"]


def test_the_papers_test_passes_minus_15_to_plus_18_percent(triangle):
    passed = passing_scale_errors(triangle)
    assert round(100 * passed.low) == -15
    assert round(100 * passed.high) == 18
    assert [row[3] for row in passed.rows()] == [100 * passed.low, 100 * passed.high]


def test_ends_are_where_the_test_turns(triangle):
    passed = passing_scale_errors(triangle)
    for end in (passed.low, passed.high):
        assert pooled_t_test(triangle, (1 + end) * triangle).p_value == pytest.approx(0.05, rel=1e-9)
        assert pooled_t_test(triangle, (1 + 1.01 * end) * triangle).rejects
        assert not pooled_t_test(triangle, (1 + 0.99 * end) * triangle).rejects


def test_few_steps_never_reject_a_larger_deformation():
    sample = np.array([0.0, 1.0, 0.0])
    passed = passing_scale_errors(sample)
    assert passed.high == math.inf
    assert not any(pooled_t_test(sample, (1 + error) * sample).rejects for error in (0.5, 5.0, 500.0))
    assert passed.to_dict()["high"] is None


def test_one_open_end_where_only_a_turned_sign_is_rejected():
    sample = np.array([0.0, 0.5, 1.5, 2.5])
    passed = passing_scale_errors(sample)
    assert passed.high == math.inf
    assert pooled_t_test(sample, (1 + passed.low) * sample).p_value == pytest.approx(0.05, rel=1e-9)
    assert not pooled_t_test(sample, 1000.0 * sample).rejects


def test_a_constant_sample_passes_nothing():
    assert passing_scale_errors(np.ones(10)).to_dict() == {"low": 0.0, "high": 0.0}


def test_power_by_the_noncentral_t(triangle):
    effect = 0.1 * triangle.mean() / np.sqrt(0.5 * triangle.var(ddof=1) * (1 + 1.1**2))
    expected = TTestIndPower().power(effect, 100, 0.05)
    assert t_test_power(triangle, 0.1) == pytest.approx(expected, rel=1e-12)
    assert t_test_power(triangle, 0.1) < 0.25


def test_power_is_about_half_at_the_ends_and_the_level_without_error(triangle):
    passed = passing_scale_errors(triangle)
    assert t_test_power(triangle, passed.low) == pytest.approx(0.5, abs=0.02)
    assert t_test_power(triangle, 0.0) == pytest.approx(0.05, rel=1e-9)
    assert t_test_power(np.ones(10), 0.1) == 1.0


def test_a_sample_of_zeros_is_refused():
    with pytest.raises(ComparisonError, match="zero throughout"):
        passing_scale_errors(np.zeros(10))
