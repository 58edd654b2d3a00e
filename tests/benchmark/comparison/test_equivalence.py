import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st
from statsmodels.stats.weightstats import ttost_ind, ttost_paired

from benchmark.comparison import (
    ComparisonError,
    history_equivalence,
    paired_equivalence,
    pooled_t_test,
    two_sample_equivalence,
)


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


def ramp(rows, hold=0):
    return np.concatenate([np.arange(1, rows + 1) / rows, np.ones(hold)])


@pytest.mark.parametrize(("off", "equivalent"), [(0.017, True), (-0.019, True), (0.0201, False), (-0.021, False)])
def test_a_history_is_judged_alike_with_any_number_of_rows(off, equivalent):
    """With steps for samples, 1.7 % was equivalent within 2 % with 100 rows and not with 8."""
    for fem in (*(ramp(rows) for rows in (8, 20, 100, 1000)), ramp(8, 1000), ramp(1000, 8)):
        found = history_equivalence(fem, (1.0 + off) * fem)
        assert found.within_margin is equivalent
        assert found.equivalent is paired_equivalence(fem, (1.0 + off) * fem).equivalent
        assert found.over_load == pytest.approx(off)
        assert found.worst == pytest.approx(off)
        assert found.p_value == paired_equivalence(fem, (1.0 + off) * fem).p_value
    assert not paired_equivalence(ramp(8), 1.017 * ramp(8)).equivalent


@pytest.mark.parametrize("rows", [8, 20, 100, 1000])
def test_what_is_small_on_average_must_be_small_in_every_step(rows):
    fem = ramp(rows)
    bump = 0.03 * np.maximum(1.0 - 8.0 * np.abs(fem - 0.5), 0.0)
    found = history_equivalence(fem, fem + bump, 0.025)
    assert abs(found.over_load) < 0.015
    assert found.worst == pytest.approx(0.03)
    assert not found.within_margin


def test_a_history_counts_the_way_down_and_a_pull_by_their_size():
    fem = np.concatenate([ramp(8), ramp(8)[-2::-1], -0.5 * ramp(4)])
    found = history_equivalence(fem, fem + 0.015 * np.abs(fem))
    assert found.over_load == pytest.approx(0.015)
    assert found.within_margin
    assert history_equivalence(fem, fem - 0.015 * np.maximum(fem, 0.0)).worst == pytest.approx(-0.015)
    cycle = np.append(fem[:15], 0.0)
    assert history_equivalence(cycle, 1.015 * cycle).over_load == pytest.approx(0.015)


@pytest.mark.parametrize("rows", [8, 20, 100, 1000])
def test_an_offset_counts_by_the_mean_over_the_load(rows):
    """Half of the peak, however many rows; the step from nought takes it up."""
    fem = ramp(rows)
    found = history_equivalence(fem, fem + 0.015)
    assert found.over_load == pytest.approx(0.03, rel=0.07)
    assert not found.within_margin
    assert history_equivalence(fem, fem + 0.009).within_margin
