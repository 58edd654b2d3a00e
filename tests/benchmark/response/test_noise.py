from itertools import pairwise

import numpy as np
import pytest

from benchmark.response.noise import effective_rows, fit_memory, lag_one, restricted_noise, scales, whitened, whitener


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


def press_columns(rows):
    """A contact's force by touch, zero and gain."""
    below = np.maximum(np.linspace(-0.3, 1.0, rows), 0.0)
    return np.column_stack([below > 0.0, np.ones(rows), below**1.3])


@pytest.mark.parametrize("memory", [0.3, 0.8, 0.95])
def test_what_a_fit_takes_along_does_not_shorten_the_memory(memory):
    columns, counts, found = press_columns(250), [np.ones(250)] * 10, []
    for seed in range(20):
        errors = 0.02 * remembered(np.random.default_rng([5, seed]), 10, 250, memory)
        left = errors - (columns @ np.linalg.lstsq(columns, errors.T, rcond=None)[0]).T
        found.append(restricted_noise(left, counts, [columns] * 10))
    told, deviations = np.mean([one for one, _ in found]), np.mean([one for _, one in found])
    assert told == pytest.approx(memory, abs=0.015)
    assert deviations * np.sqrt(1.0 - told**2) == pytest.approx(0.02 * np.sqrt(1.0 - memory**2), rel=0.03)


def test_it_is_the_restricted_likelihood_of_patterson_and_thompson():
    columns, rows = press_columns(60), 60
    error = remembered(np.random.default_rng(8), 1, rows, 0.6)[0]

    def dense(memory):
        inverse = np.linalg.inv(memory ** np.abs(np.subtract.outer(np.arange(rows), np.arange(rows))))
        inner = columns.T @ inverse @ columns
        left = error - columns @ np.linalg.solve(inner, columns.T @ inverse @ error)
        free = rows - columns.shape[1]
        return free * np.log(left @ inverse @ left) - np.linalg.slogdet(inverse)[1] + np.linalg.slogdet(inner)[1]

    tried = np.linspace(0.01, 0.99, 981)
    best = tried[np.argmin([dense(each) for each in tried])]
    assert restricted_noise([error], [np.ones(rows)], [columns])[0] == pytest.approx(best, abs=3e-3)


def test_trials_with_no_more_rows_than_columns_have_no_noise_of_their_own():
    rng, counts = np.random.default_rng(9), [np.ones(3), np.ones(120), np.zeros(50)]
    errors = [remembered(rng, 1, one.size, 0.5)[0] for one in counts]
    memory, deviations = restricted_noise(errors, counts, [press_columns(one.size) for one in counts])
    assert np.isfinite(deviations).tolist() == [False, True, False]
    assert 0.0 <= memory < 0.99


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


def test_columns_that_hold_the_noise_of_the_depth_make_it_no_memory():
    """A force over a depth read with white noise: of ten trials a memory of 0.998 was told, and 8 kPa for 20."""
    rng = np.random.default_rng(11)
    ramp = np.concatenate([np.linspace(0.0, 1.0, 60), np.ones(40), np.linspace(1.0, 0.1, 60), np.full(80, 0.1)])
    errors, columns = [], []
    for _ in range(10):
        read = ramp + 0.02 * rng.normal(size=ramp.size)
        errors.append(ramp - read)
        columns.append(np.column_stack([np.where(read > 0.05, 1.0, 0.0), np.ones_like(read), read]))
    memory, deviations = restricted_noise(errors, [np.ones(ramp.size)] * 10, columns)
    assert memory < 0.1
    assert deviations == pytest.approx(np.full(10, 0.02), rel=0.2)
