import math

import numpy as np
import pytest
from statsmodels.stats.power import TTestIndPower

from benchmark.comparison import ComparisonError, passing_scale_errors, pooled_t_test, t_test_power


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
