from itertools import pairwise

import numpy as np
import pytest

from benchmark.response.noise import effective_rows, fit_memory, lag_one, scales, whitened, whitener


def remembered(rng, trials, size, memory):
    shocks = rng.normal(0.0, np.sqrt(1 - memory**2), (trials, size))
    out = np.zeros((trials, size))
    out[:, 0] = rng.normal(size=trials)
    for k in range(1, size):
        out[:, k] = memory * out[:, k - 1] + shocks[:, k]
    return out


def test_means_of_remembered_noise_come_out_white():
    rng = np.random.default_rng(1)
    raw = remembered(rng, 400, 240, 0.7)
    means = raw.reshape(400, 40, 6).mean(axis=2)
    white = np.array([whitener(np.full(40, 6.0), 0.7)(row) for row in means])
    assert white.std() == pytest.approx(1.0, rel=0.03)
    assert np.mean(white[:, 1:] * white[:, :-1]) == pytest.approx(0.0, abs=0.02)


def test_rows_of_different_sizes_come_out_alike():
    rng = np.random.default_rng(2)
    raw = remembered(rng, 2000, 24, 0.6)
    sizes = np.array([1, 1, 2, 4, 8, 4, 2, 1, 1])
    edges = np.cumsum([0, *sizes])
    means = np.column_stack([raw[:, a:b].mean(axis=1) for a, b in pairwise(edges)])
    white = np.array([whitener(sizes.astype(float), 0.6)(row) for row in means])
    assert white.std(axis=0) == pytest.approx(np.ones(sizes.size), rel=0.06)


def test_a_trial_without_samples_has_no_scale_and_no_say():
    errors = 0.02 * remembered(np.random.default_rng(4), 3, 200, 0.5)
    counts = np.ones((3, 200))
    counts[1] = 0.0
    found = scales(errors, counts, 0.5)
    assert np.isfinite(found).tolist() == [True, False, True]
    assert fit_memory(errors, counts) == fit_memory(errors[::2], counts[::2])


def test_the_memory_and_the_scale_are_found():
    rng = np.random.default_rng(3)
    errors = 0.02 * remembered(rng, 6, 400, 0.85)
    counts = np.ones((6, 400))
    assert fit_memory(errors, counts) == 0.85
    assert scales(errors, counts, 0.85) == pytest.approx(np.full(6, 0.02), rel=0.12)


def test_a_row_without_a_sample_weighs_nothing():
    use = whitener(np.array([1.0, 0.0, 1.0]), 0.6)
    assert abs(use(np.array([0.0, 1.0, 0.0]))).max() < 2e-3


def test_rows_without_samples_do_not_break_the_chain():
    rng = np.random.default_rng(4)
    rows = np.zeros((400, 60))
    count = np.tile([1.0, 0.0, 0.0], 20)
    rows[:, count > 0.0] = remembered(rng, 400, 20, 0.8)
    use = whitener(count, 0.8)
    white = np.array([use(row) for row in rows])[:, count > 0.0]
    assert white.std() == pytest.approx(1.0, rel=0.05)
    assert abs(np.mean(white[:, 1:] * white[:, :-1])) < 0.05


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
