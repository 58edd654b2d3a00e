import numpy as np
import pytest

from benchmark.fitting.autocorrelation import effective_rows, lag_one, whitened


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9])
def test_estimate_has_little_bias(ar1, rho):
    generator = np.random.default_rng(7)
    found = [lag_one(ar1(generator, 160, rho)) for _ in range(400)]
    assert np.mean(found) == pytest.approx(rho, abs=0.04)


def test_never_negative_and_zero_for_no_residual():
    assert lag_one(np.array([1.0, -1.0] * 50)) == 0.0
    assert lag_one(np.zeros(20)) == 0.0


def test_effective_rows_match_the_variance_of_the_mean(ar1):
    generator = np.random.default_rng(1)
    means = [ar1(generator, 400, 0.8).mean() for _ in range(1500)]
    assert 1 / np.var(means) == pytest.approx(effective_rows(400, 0.8), rel=0.1)


def test_whitening_removes_the_correlation(ar1):
    noise = ar1(np.random.default_rng(2), 5000, 0.8)
    assert lag_one(whitened(noise[:, None], 0.8)[:, 0]) < 0.05
