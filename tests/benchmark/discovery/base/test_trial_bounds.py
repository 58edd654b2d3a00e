"""What each trial has of its own stays within what physics allows, and what is large is said."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import EffectModel, fit
from benchmark.discovery.base.trial_bounds import (
    gains_between,
    large_remarks,
    late_by_speed,
    touch_range,
    trial_bounds,
    trial_values,
    zero_range,
)
from benchmark.discovery.base.trials_problem import OWN, NoiseModel, TrialPrior, TrialsProblem, trial_refs
from benchmark.discovery.trials.preparing import prepare
from benchmark.files import load_session
from benchmark.response.elastic_table import ElasticTable

LATE = 0.5


@pytest.fixture(scope="module")
def problem(tmp_path_factory, quick_session):
    session = load_session(quick_session.write_session(tmp_path_factory.mktemp("own") / "own", trials=3))
    study = prepare(session, 60)
    depth = np.linspace(0.0, 4e-3, 400)
    table = ElasticTable(depth, quick_session.law(depth), np.array([0.0, 1.0]))
    noise = NoiseModel((0.6,), np.full((6, 1), 0.005 * float(table.force.max())))
    return TrialsProblem(study, (table, table), noise, TrialPrior(0.1, 0.5, 1.0, 1e-3, 1e-2), trial_refs(study))


def test_a_zero_is_what_the_sensor_shows_at_rest(problem):
    trial, noise = problem.trials[0], float(problem.noise.scale[0, 0])
    low, high = zero_range(problem, trial, noise)
    resting = trial.signals[trial.motion.depth <= 0.0, 0][:5]
    assert low <= resting.min() <= resting.max() <= high
    assert high - low < np.ptp(resting) + 2.0 * criteria.OVER_NOISE * noise + 10.0 * noise


def test_a_tool_touches_no_deeper_than_where_the_force_has_risen(problem):
    trial, noise = problem.trials[0], float(problem.noise.scale[0, 0])
    low, high = touch_range(problem, trial, noise)
    risen = trial.signals[:, 0] > np.median(trial.signals[:4, 0]) + 3.0 * criteria.RISEN * noise
    assert 0.0 < high <= trial.motion.depth[risen].min()
    early = criteria.EARLY_TOUCH * trial.motion.depth.max()
    assert low == pytest.approx(-high - early)
    later = replace(trial, motion=replace(trial.motion, depth=trial.motion.depth + 1e-3))
    assert touch_range(problem, later, noise)[1] > high + 0.5e-3


def test_a_force_in_air_says_how_far_before_its_zero_a_tool_had_touched(problem):
    trial, noise = problem.trials[0], float(problem.noise.scale[0, 0])
    peak, most = float(np.ptp(trial.signals[:, 0])), float(trial.motion.depth.max())
    low, high = touch_range(problem, trial, noise)
    pressed = trial.signals.copy()
    last = np.flatnonzero(
        (trial.motion.depth <= 0.0) & (trial.motion.time < trial.motion.time[trial.motion.depth.argmax()])
    )
    pressed[last[-1], 0] += 0.2 * peak
    early, _ = touch_range(problem, replace(trial, signals=pressed), noise)
    assert low == pytest.approx(-high - criteria.EARLY_TOUCH * most)
    assert -high - 0.3 * most < early < -high - 0.18 * most


def test_a_clock_that_is_far_too_late_is_followed_to_its_bound_and_said(problem):
    slow = [replace(t, motion=replace(t.motion, time=t.motion.time), signals=_later(t)) for t in problem.trials]
    late = replace(problem, trials=tuple(slow))
    model = EffectModel(late, ())
    fitted = fit(model, np.zeros(model.size))
    high = trial_bounds(late)[1][:, 2]
    assert high == pytest.approx(max(criteria.LATEST, criteria.LATE_ROWS * problem.study.raw_interval))
    assert (fitted.nuisance[:, 2] == high).any()
    assert any("shift" in own.at_bound for own in trial_values(late, fitted.nuisance))
    assert "late by" in large_remarks(late, fitted.nuisance)[0]


def test_what_is_small_is_not_warned_of(problem):
    assert large_remarks(problem, np.zeros((6, len(OWN)))) == ()
    for fold, said in ((2.3, True), (0.4, True), (1.4, False)):
        own = np.zeros((6, len(OWN)))
        own[:, OWN.index("gain")] = np.random.default_rng(1).normal(0.0, 0.03, 6)
        own[4, OWN.index("gain")] = np.log(fold)
        assert any(f"{problem.trials[4].name}: " in text for text in large_remarks(problem, own)) is said
    own[:, OWN.index("gain")] = np.log([1.0, 1.9, 0.5, 1.4, 2.1, 0.6])  # specimens that differ
    assert not any("as stiff as" in text for text in large_remarks(problem, own))


def test_touches_that_are_late_together_are_said(problem):
    def said(touch):
        own = np.zeros((6, len(OWN)))
        own[:, OWN.index("height")] = touch
        return large_remarks(problem, own)

    size = 0.01 * min(condition.around.peak_depth for condition in problem.study.conditions)
    scatter = size * np.array([-1.0, 1.0, -1.0, 1.0, -1.0, 1.0])
    late = 2.2 * size + 0.8 * scatter
    (text,) = said(late)
    assert f"touches {2.2e3 * size:.2g} mm behind its zero in the mean of the trials, give or take" in text
    for other in (-late, size + scatter, 0.1 * size + 0.01 * scatter):
        assert said(other) == ()
    scattered = 2.2 * size + 1.5 * scatter  # 3.3 standard errors
    assert not any("in the mean" in each for each in said(scattered))
    large, together = said(late + np.array([4.0 * size, 0.0, 0.0, 0.0, 0.0, 0.0]))
    assert "touches at" in large
    assert together.startswith("the tool touches")


WAVES = 1e-3 * np.array([-1.0, 1.0, 0.0])


def _clocks(slow, fast):
    """Time shifts, s, of three trials at 1.5 mm/s and three at 6 mm/s that scatter by a millisecond."""
    return np.concatenate([slow + WAVES, fast + WAVES])


def test_time_shifts_that_go_with_the_speed_are_no_clocks(problem):
    (slow, at_slow), (fast, at_fast) = late_by_speed(problem, _clocks(12e-3, 3e-3))
    assert (slow, fast) == (pytest.approx(1.5e-3, rel=0.02), pytest.approx(6e-3, rel=0.02))
    assert (at_slow, at_fast) == (pytest.approx(12e-3), pytest.approx(3e-3))
    for other in ((12e-3, 12e-3), (3e-3, 7.9e-3), (0.0, 0.0)):  # a late sensor; less than a filter does; nothing
        assert late_by_speed(problem, _clocks(*other)) is None
    scattered = _clocks(12e-3, 3e-3) + 4.0 * np.tile(WAVES, 2)  # 2.2 standard errors
    assert late_by_speed(problem, scattered) is None
    slow = problem.study.conditions[0]
    near = replace(problem.study, conditions=(slow, replace(slow, time=0.75 * slow.time)))
    assert late_by_speed(replace(problem, study=near), _clocks(12e-3, 3e-3)) is None


@pytest.mark.parametrize(
    ("slow", "fast", "words"),
    [
        (12e-3, 3e-3, "late by 12 ms at 1.5 mm/s and by 3 ms at 6 mm/s: no clock is, but play at each turn looks so"),
        (-12e-3, -3e-3, "late by -12 ms at 1.5 mm/s and by -3 ms at 6 mm/s: no clock is, but friction looks so"),
        (9e-3, 9e-3, "late by 9 ms in the mean of the trials, give or take 0.4 ms: a sensor's filter, or, since play"),
        (-9e-3, -9e-3, "late by -9 ms in the mean of the trials, give or take 0.4 ms: a sensor's filter, or, since fr"),
    ],
)
def test_time_shifts_that_trials_share_are_said(problem, slow, fast, words):
    own = np.zeros((6, len(OWN)))
    own[:, OWN.index("shift")] = _clocks(slow, fast)
    (text,) = large_remarks(problem, own)
    assert words in text


@pytest.mark.parametrize(
    ("apart", "scatter", "said"),
    [(0.3, 0.01, True), (0.08, 0.02, False), (0.08, 0.01, True), (0.04, 0.001, False), (0.3, 0.06, False)],
)
def test_gains_that_part_conditions_are_said(problem, apart, scatter, said):
    own = np.zeros((6, len(OWN)))
    own[:, OWN.index("gain")] = np.repeat([0.0, np.log1p(apart)], 3) + scatter * np.tile([-1.0, 1.0, 0.0], 2)
    words = f"gains are {100.0 * apart:.2g} % larger in speed 6 than in speed 1.5: what makes one condition stiffer"
    assert any(words in text for text in large_remarks(problem, own)) is said


def test_a_specimen_that_dries_through_the_session_parts_its_conditions(problem):
    drying = 0.02 * np.arange(6.0)
    assert gains_between(problem, drying) == ("speed 6", "speed 1.5", pytest.approx(0.06))
    assert gains_between(problem, drying[[1, 0, 2, 3, 5, 4]]) is None  # in no sure order, and within its scatter
    assert gains_between(problem, 0.01 * np.arange(6.0)) is None  # less than a told tool may be off by


@pytest.mark.parametrize(
    ("gains", "words"),
    [
        ([1.25, 1.1, 1.02, 0.98, 0.95, 0.94], "fall by 20 % from the first to the last of speed 1.5"),
        ([0.9, 0.94, 0.97, 1.0, 1.03, 1.08], "rise by 15 % from the first to the last of speed 1.5"),
        ([1.02, 1.01, 1.0, 0.99, 0.98, 0.97], None),  # less than is warned of
        ([1.25, 0.94, 1.02, 0.98, 1.1, 0.95], None),  # in no order
        ([1.25, 1.1, 1.02, 0.98, 0.95], None),  # too few
    ],
)
def test_gains_that_go_one_way_are_said(problem, gains, words):
    trials = tuple(replace(problem.trials[0], number=3 * place) for place in range(len(gains)))
    one = replace(problem, trials=trials[::-1], study=replace(problem.study, conditions=problem.study.conditions[:1]))
    one = replace(one, noise=NoiseModel((0.6,), np.resize(problem.noise.scale, (len(gains), 1))))
    own = np.zeros((len(gains), len(OWN)))
    own[:, OWN.index("gain")] = np.log(gains[::-1])
    said = large_remarks(one, own)
    assert said == () if words is None else words in said[0]


def _later(trial):
    shifted = np.interp(trial.motion.time - LATE, trial.motion.time, trial.signals[:, 0])
    return shifted[:, None]
