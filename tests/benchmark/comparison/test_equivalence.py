import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st
from statsmodels.stats.weightstats import ttost_ind, ttost_paired

from benchmark.comparison import ComparisonError, paired_equivalence, pooled_t_test, two_sample_equivalence


def test_rejects_the_bias_that_the_pooled_t_test_lets_pass(triangle):
    wave = 1.1 * triangle
    assert not pooled_t_test(triangle, wave).rejects
    for margin in (0.01, 0.02, 0.05):
        assert not paired_equivalence(triangle, wave, margin).equivalent


def test_shows_equivalence_of_a_small_bias(triangle):
    wave = 1.001 * triangle
    assert paired_equivalence(triangle, wave, 0.02).equivalent
    assert not paired_equivalence(triangle, wave, 0.0005).equivalent


def test_the_two_sample_form_cannot_show_equivalence_of_equal_samples(triangle):
    assert not two_sample_equivalence(triangle, triangle, 0.02).equivalent
    assert two_sample_equivalence(triangle, triangle, 0.2).equivalent


def test_same_as_statsmodels():
    generator = np.random.default_rng(8)
    fem = generator.normal(1.0, 0.3, 50)
    wave = fem + generator.normal(0.01, 0.05, 50)
    margin = 0.02 * abs(fem.mean())
    paired, p_paired = paired_equivalence(fem, wave), ttost_paired(wave, fem, -margin, margin)[0]
    two, p_two = two_sample_equivalence(fem, wave), ttost_ind(wave, fem, -margin, margin)[0]
    assert paired.p_value == pytest.approx(p_paired, rel=1e-12)
    assert two.p_value == pytest.approx(p_two, rel=1e-12)
    assert paired.margin == two.margin == pytest.approx(margin)


@pytest.mark.parametrize("form", [paired_equivalence, two_sample_equivalence])
def test_equivalent_exactly_where_the_90_percent_interval_is_inside(form):
    generator = np.random.default_rng(11)
    outcomes = set()
    for _ in range(60):
        fem = generator.normal(1.0, 0.05, 12)
        result = form(fem, fem + generator.normal(generator.uniform(-0.05, 0.05), 0.03, 12), 0.04)
        inside = -result.margin < result.ci90_low and result.ci90_high < result.margin
        assert result.equivalent == inside
        outcomes.add(inside)
    assert outcomes == {True, False}


def test_interval_by_hand():
    result = paired_equivalence([10.0, 10.0, 10.0], [10.1, 10.2, 10.3], 0.05)
    half = scipy.stats.t.ppf(0.95, 2) * 0.1 / np.sqrt(3)
    assert result.difference == pytest.approx(0.2)
    assert result.ci90_high == pytest.approx(0.2 + half, rel=1e-12)
    assert result.t_low == pytest.approx((0.2 + 0.5) / (0.1 / np.sqrt(3)), rel=1e-12)


@pytest.mark.parametrize(("shift", "equivalent"), [(0.0, True), (0.01, True), (0.03, False), (-0.03, False)])
@pytest.mark.parametrize("form", [paired_equivalence, two_sample_equivalence])
def test_without_spread_the_interval_is_a_point(form, shift, equivalent):
    result = form(np.ones(10), np.full(10, 1.0 + shift), 0.02)
    assert result.equivalent is equivalent
    assert result.p_value in (0.0, 1.0)
    assert result.note


@pytest.mark.parametrize("margin", [0.0, -0.1, np.nan, np.inf])
def test_margin_must_be_positive(triangle, margin):
    with pytest.raises(ComparisonError, match="margin"):
        paired_equivalence(triangle, triangle, margin)


def test_a_mean_of_zero_has_no_margin():
    with pytest.raises(ComparisonError, match="mean of fem is zero"):
        paired_equivalence([-1.0, 1.0], [-1.0, 1.0])


@given(st.floats(0.01, 100.0), st.integers(0, 50))
def test_free_of_scale_and_sign(scale, seed):
    generator = np.random.default_rng(seed)
    fem = generator.uniform(0.5, 1.5, 20)
    wave = fem + generator.normal(0.01, 0.02, 20)
    p = paired_equivalence(fem, wave).p_value
    assert paired_equivalence(scale * fem, scale * wave).p_value == pytest.approx(p, rel=1e-6, abs=1e-12)
    assert paired_equivalence(-fem, -wave).p_value == pytest.approx(p, rel=1e-9, abs=1e-15)
