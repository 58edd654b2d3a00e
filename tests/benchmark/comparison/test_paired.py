import numpy as np
import pytest
import scipy

from benchmark.comparison import paired_t_test


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
