"""What is closed and what trials share: told from round-off and from what each has of its own."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.answer import gap as module
from benchmark.discovery.answer.gap import (
    HeldOut,
    closed_overall,
    gaps,
    held_out_residuals,
    share_closed,
    share_left,
    traces,
    unbent,
    worse,
)
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.disagreement import shared_misfit
from benchmark.discovery.discovery_result import ChannelGap
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import Motion, catalogue


@pytest.mark.parametrize(
    ("before", "after", "floor", "expected"),
    [
        (4.0, 2.0, 1.0, 2.0 / 3.0),
        (4.0, 0.5, 1.0, 1.0),  # below the floor: all that can be closed
        (4.0, 5.0, 1.0, -1.0 / 3.0),
        (1.0, 0.25, 0.0, 0.75),
    ],
)
def test_share_of_what_lies_above_the_floor(before, after, floor, expected) -> None:
    assert share_closed(before, after, floor) == pytest.approx(expected, abs=1e-6)


def test_nothing_to_close_where_the_base_reaches_the_floor() -> None:
    assert share_closed(1.04, 1.0, 1.0) is None
    assert share_closed(0.9, 0.8, 1.0) is None


def test_round_off_is_not_a_share() -> None:
    assert str(share_closed(2.0, 2.0 * (1.0 + 1e-13), 1.0)) == "0.0"


BY_SLUG = {effect.slug: effect for effect in catalogue()}


def drifting(time, depth, elastic):
    return elastic + 0.02 * (time - time[0])


def test_the_right_effect_leaves_little_and_a_wrong_one_nearly_all(session_of):
    session = session_of(force=drifting, noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    assert shared_misfit(base) > 200.0
    assert share_left(base, fit_candidate(base, BY_SLUG["force_drift"])) < 0.1
    assert share_left(base, fit_candidate(base, BY_SLUG["tool_inertia"])) > 0.7


def measured(residuals, conditions, counts=None):
    """A base and residuals (R, n, C) of its trials, as `gaps` wants them."""
    residuals = np.asarray(residuals, dtype=float)
    counts = np.ones(residuals.shape[1:]) if counts is None else np.asarray(counts, dtype=float)
    trials = tuple(
        SimpleNamespace(
            name=f"t{k}",
            condition=condition,
            signals=np.full(counts.shape, 5.0),
            count=counts,
            motion=Motion(np.arange(len(counts)), np.zeros(len(counts)), np.zeros(len(counts))),
        )
        for k, condition in enumerate(conditions)
    )
    names = {number: SimpleNamespace(name=f"c{number}") for number in conditions}
    study = SimpleNamespace(channels=("force_z", "marker_x", "marker_x")[: residuals.shape[2]], conditions=names)
    return SimpleNamespace(model=SimpleNamespace(problem=SimpleNamespace(trials=trials, study=study)))


def held(before, after, kind="trial"):
    return HeldOut(list(np.asarray(before, dtype=float)), list(np.asarray(after, dtype=float)), kind)


def floors(monkeypatch, values):
    monkeypatch.setattr(module, "floors", lambda base: list(np.asarray(values, dtype=float)))


def test_the_gap_of_a_channel_is_its_root_mean_square_over_trials_and_samples(monkeypatch):
    before = np.stack([np.full((4, 1), 3.0), np.full((4, 1), 4.0)])
    after = np.stack([np.full((4, 1), 1.0), np.full((4, 1), 2.0)])
    floors(monkeypatch, np.full((2, 4, 1), 1.0))
    (gap,) = gaps(measured(before, (0, 0)), held(before, after, "condition"), Settings(bootstraps=20))
    assert (gap.rmse_before, gap.rmse_after, gap.noise_floor) == pytest.approx((12.5**0.5, 2.5**0.5, 1.0))
    assert gap.closed == pytest.approx(10.0 / 11.5, abs=1e-6)
    assert gap.held_out == "condition"
    low, high = gap.ci95
    assert 8.0 / 8.0 >= high >= gap.closed >= low >= 12.0 / 15.0 - 1e-6  # one trial alone at either end


def test_rows_without_samples_do_not_count(monkeypatch):
    before = np.array([[[3.0], [100.0]]] * 2)
    floors(monkeypatch, np.zeros((2, 2, 1)))
    (gap,) = gaps(measured(before, (0, 0), [[2.0], [0.0]]), held(before, before), Settings(bootstraps=5))
    assert gap.rmse_before == pytest.approx(3.0)


def test_a_trial_without_mates_has_the_floor_of_the_others(monkeypatch):
    before = np.full((3, 4, 1), 2.0)
    error = np.full((3, 4, 1), 0.5)
    error[2] = np.nan
    floors(monkeypatch, error)
    (gap,) = gaps(measured(before, (0, 0, 1)), held(before, before), Settings(bootstraps=5))
    assert gap.noise_floor == pytest.approx(0.5)


def test_where_no_replicates_tell_the_noise_the_whole_gap_is_unknown_and_nothing_warns(monkeypatch):
    before = np.full((2, 4, 1), 2.0)
    floors(monkeypatch, np.full((2, 4, 1), np.nan))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert closed_overall(measured(before, (0, 1)), held(before, 0.5 * before)) is None
        (gap,) = gaps(measured(before, (0, 1)), held(before, 0.5 * before), Settings(bootstraps=5))
    assert (gap.noise_floor, gap.closed, gap.ci95) == (None, None, None)
    assert (gap.rmse_before, gap.rmse_after) == (2.0, 1.0)


def test_channels_count_together_in_units_of_their_noise(monkeypatch):
    before = np.full((2, 4, 2), 1.0) * [3.0, 3e-6]
    after = np.full((2, 4, 2), 1.0) * [1.0, 3e-6]
    floors(monkeypatch, np.full((2, 4, 2), 1.0) * [1.0, 1e-6])
    assert closed_overall(measured(before, (0, 0)), held(before, after)) == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize(
    ("interval", "force_after", "expected"),
    [
        ((-0.15, -0.01), [2.0, 2.1, 2.0, 2.1], True),  # as it was
        ((-0.15, -0.01), [2.2, 2.3, 2.2, 2.3], True),  # worse there, too
        ((-0.15, -0.01), [1.7, 2.5, 1.8, 2.2], True),  # less on some trials, not surely
        ((-0.15, -0.01), [1.9, 2.0, 1.9, 2.0], False),  # a little less on each, below what replicates differ by
        ((-0.1, 0.1), [2.0, 2.1, 2.0, 2.1], False),  # no gap surely grows
        (None, [2.0, 2.1, 2.0, 2.1], False),  # nothing to close
    ],
)
def test_effects_predict_nothing_where_a_gap_surely_grows_and_no_channel_is_missed_by_less(
    interval, force_after, expected
):
    before = np.ones((4, 5, 2)) * np.array([2.0, 2.1, 2.0, 2.1])[:, None, None]
    after = before.copy()
    after[:, :, 0] = np.array(force_after)[:, None]
    channels = [ChannelGap("force_z", 2.0, 2.0, 3.0, None, None, "condition")]
    channels += [ChannelGap("marker_x", 2.0, 2.0, 1.0, None, interval, "condition")]
    base = measured(before, (0, 0, 1, 1))
    assert not module.grows(base, held(before, after), channels, Settings(bootstraps=200))  # by nothing but round-off
    after[:, :, 1] *= 1.02
    assert module.grows(base, held(before, after), channels, Settings(bootstraps=200)) is expected
    assert module.shrinks(base, held(before, after), Settings(bootstraps=200)) is (force_after == [1.9, 2.0, 1.9, 2.0])


def test_a_condition_held_out_is_predicted_by_the_others_and_a_trial_by_its_mates(monkeypatch):
    asked = []
    monkeypatch.setattr(module, "_without", lambda fit, left: None)
    monkeypatch.setattr(module, "_residuals", lambda fit, parts, known: asked.append(np.array(parts)) or [])
    two, one, many = (measured(np.zeros((len(c), 4, 1)), c) for c in ((0, 0, 1), (0, 0, 0), (0,) * 7))
    assert held_out_residuals(two, two).kind == "condition"
    assert held_out_residuals(one, one).kind == "trial"
    held_out_residuals(many, many)
    conditions, trials, fifths = asked
    np.testing.assert_array_equal(conditions, [[True, True, False], [False, False, True]])
    np.testing.assert_array_equal(trials, np.eye(3, dtype=bool))
    assert (fifths.shape, fifths.sum(axis=0).tolist()) == ((5, 7), [1] * 7)


def test_what_the_other_trials_do_not_show_foretells_nothing(monkeypatch):
    base, chosen = (measured(np.zeros((4, 4, 1)), (0, 0, 1, 1)) for _ in range(2))
    said = {True: -5.0, False: -3.0}  # BIC of the trials of the first condition, and of the second
    monkeypatch.setattr(module, "_without", lambda fit, left: SimpleNamespace(of=fit, first=not left[0]))
    monkeypatch.setattr(module, "effective_size", lambda fit: 100.0)
    monkeypatch.setattr(module, "delta_bic", lambda made, other, samples: said[made.first])
    used = []
    monkeypatch.setattr(module, "_residuals", lambda fit, parts, known: used.append([each.of for each in known]) or [])
    held_out_residuals(base, chosen)
    assert [[each is chosen for each in part] for part in used] == [[False, False], [False, True]]


def test_curves_are_measured_less_residual_and_empty_where_nothing_was_seen(monkeypatch):
    before = np.full((2, 3, 1), 2.0)
    floors(monkeypatch, np.full((2, 3, 1), 0.5))
    first, second = traces(measured(before, (0, 0), [[1.0], [0.0], [1.0]]), held(before, 0.5 * before))
    np.testing.assert_allclose(first.before, 3.0)
    np.testing.assert_allclose(first.after, 4.0)
    np.testing.assert_allclose(first.noise, 0.5)
    np.testing.assert_allclose(second.measured, [5.0, np.nan, 5.0])
    assert (first.trial, second.trial, first.condition, first.channel) == ("t0", "t1", "c0", "force_z")


def graded(before, after, conditions):
    """What `worse` says of residuals (R, n, C) in a problem whose noise is 1 in force and 1e-6 in markers."""
    base = measured(before, conditions)
    noise = np.array([1.0, 1e-6, 1e-6])[: np.shape(before)[2]]
    base.model.problem.noise = SimpleNamespace(scale=np.tile(noise, (len(conditions), 1)))
    return worse(base, held(before, after))


def test_a_condition_that_is_predicted_worse_is_told_by_name_force_and_markers_alike():
    before = np.ones((4, 5, 2)) * [3.0, 3e-6]
    assert graded(before, 0.5 * before, (0, 0, 1, 1)) == ()
    half = before * np.array([0.5, 0.5, 2.0, 2.0])[:, None, None]
    assert graded(before, half, (0, 0, 1, 1)) == ("c1",)
    assert graded(before, 1.005 * before, (0, 0, 1, 1)) == ()  # the last steps of a fit
    markers = before * [0.9, 2.0]  # a little better in force, twice as bad in markers
    assert graded(before, markers, (0, 0, 0, 0)) == ("c0",)


def exponential(time, depth, elastic):
    """A purely elastic force that no base follows."""
    return 0.3 * np.expm1(1.2e3 * np.maximum(depth, 0.0))


@pytest.mark.slow
def test_before_has_converged_and_stays_near_what_was_measured(session_of):
    session = session_of(force=exponential, noise=0.003, trials=3)
    base = calibrate(session, prepare(session, 60)).base
    chosen = fit_candidate(base, BY_SLUG["pretension"], most=2)  # where a search may leave it
    plain = unbent(base, chosen)
    again = unbent(plain, plain)
    assert again.objective == pytest.approx(plain.objective, rel=1e-3)
    peak = max(trial.signals.max() for trial in base.model.problem.trials)
    predicted = [
        (trial.signals - rows).max()
        for trial, rows in zip(base.model.problem.trials, held_out_residuals(plain, plain).before, strict=True)
    ]
    assert max(predicted) < 1.3 * peak
    assert np.ptp(predicted) > 0.0


def test_specimens_that_differ_are_no_replicates(monkeypatch):
    base = measured(np.zeros((4, 3, 1)), (0, 0, 0, 0))
    asked = []
    monkeypatch.setattr(module, "pure_errors", lambda fit, alike: asked.append(alike) or [])
    for trial, row in zip(base.model.problem.trials, range(4), strict=True):
        trial.row = row
    base.nuisance = np.zeros((4, 4))
    base.model.problem.study.conditions[0].specimens = np.array([0, 0, 1, 2])
    module.floors(base)
    assert asked[-1] == (0, 0, 1, 2)
    base.nuisance[:, 0] = [0.0, 0.8, 0.0, 0.0]  # twice as stiff: another specimen, whatever is told
    module.floors(base)
    assert len(set(asked[-1])) == 4
