"""Long trials are averaged down without mixing what was never measured together."""

import numpy as np
import pytest

from benchmark.identification.trial_data import PER_STROKE, TrialData, group_bounds, reduced, rows_of, turning_rows
from benchmark.identification.trial_fit import fit_trial
from benchmark.response.force_curve import ForceCurve

DEPTH = 3e-3
CURVE = ForceCurve(np.linspace(0.0, 4e-3, 200), 2.0 * (np.linspace(0.0, 4e-3, 200) / 3e-3) ** 1.5)


def cycles(rows, count, noise=0.0, seed=0):
    """A trial of `count` triangles, with the onset at 0.1 mm and the stiffness factor 1.3."""
    share = np.arange(rows) * (count / rows) % 1.0
    depth = 2.0 * DEPTH * np.minimum(share, 1.0 - share)
    force = 1.3 * CURVE(depth - 1e-4) + np.random.default_rng(seed).normal(0.0, noise, rows)
    return TrialData("press", "slow", np.arange(rows) * 1e-3, depth, force, CURVE)


def test_a_trial_of_few_cycles_is_averaged_as_a_whole():
    trial = cycles(100_000, 10)
    starts, ends = group_bounds(trial.depth, 2000)
    assert (starts[0], ends[-1], len(starts)) == (0, trial.rows, 2000)
    assert (starts[1:] == ends[:-1]).all()


@pytest.mark.parametrize("count", [60, 500, 5000])
def test_of_many_cycles_some_are_followed_closely_and_none_across_a_turn(count):
    trial = cycles(500_000, count)
    starts, ends = group_bounds(trial.depth, 2000)
    assert len(starts) <= 2000
    assert starts[0] == 0
    assert ends[-1] >= 0.99 * trial.rows * (1 - 1 / count)
    spans = np.array([np.ptp(trial.depth[a:b]) for a, b in zip(starts, ends, strict=True)])
    assert spans.max() <= 1.6 * DEPTH / min(PER_STROKE, 500_000 / count / 2)


def test_turns_are_found_through_noise_and_nothing_else_is_one():
    trial = cycles(50_000, 25)
    noisy = trial.depth + np.random.default_rng(1).normal(0.0, 0.02 * DEPTH, trial.rows)
    assert len(turning_rows(noisy)) == 2 * 25 + 1
    assert turning_rows(np.zeros(1000)).tolist() == [0, 1000]
    assert turning_rows(np.linspace(0.0, 1.0, 1000)).tolist() == [0, 1000]


def test_the_rows_of_a_reduced_trial_are_those_of_the_curve():
    trial = reduced(cycles(1_000_000, 500), 2000)
    assert (np.diff(trial.time) > 0.0).all()
    np.testing.assert_allclose(trial.force, 1.3 * CURVE(trial.depth - 1e-4), atol=0.004)


@pytest.mark.parametrize("count", [60, 61, 500, 777])
@pytest.mark.parametrize("first", [0, 300])
def test_depths_follow_one_another_without_a_leap(count, first):
    """A leap from a shallow row to the deepest one was taken for the instant of contact."""
    whole = cycles(500_000, count)
    trial = reduced(rows_of(whole, slice(first, None)), 2000)
    assert np.abs(np.diff(trial.depth)).max() < 0.1 * DEPTH


def test_many_cycles_tell_the_stiffness_that_was_put_in():
    """Averaged over quarters of cycles this trial was refused: no force rose with depth over the noise."""
    fit = fit_trial(cycles(1_000_000, 500, noise=0.01))
    assert fit.stiffness == pytest.approx(1.3, rel=0.01)
    assert fit.onset == pytest.approx(1e-4, abs=2e-5)
