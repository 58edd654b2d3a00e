"""Tests that share the level, trends over trials, and the smallest disagreement that could have been seen."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.discovery import criteria
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection import disagreement
from benchmark.discovery.detection.cells import Cell, CellTable, FlipTest
from benchmark.discovery.detection.disagreement import (
    Detection,
    combined,
    detect,
    exchangeable,
    nothing_amiss,
    shared_by_chance,
    shared_misfit,
    smallest_visible,
    strained,
)
from benchmark.discovery.detection.places import shared_places
from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.trials.preparing import prepare

PROBABILITY = st.floats(0.0, 1.0)


@given(st.lists(PROBABILITY, min_size=1, max_size=3))
def test_the_combined_p_is_none_of_the_tests_own(values):
    p = combined(*values)
    assert min(values) <= p <= 1.0
    assert p >= min(value / share for value, share in zip(values, criteria.LEVEL_SHARES, strict=False)) or p == 1.0


def test_the_shares_use_the_level_up():
    assert sum(criteria.LEVEL_SHARES) == pytest.approx(1.0)
    assert combined(0.7 * 0.05, 1.0, 1.0) == pytest.approx(0.05)
    assert combined(1.0, 0.15 * 0.05) == pytest.approx(0.05)


def test_three_tests_of_chance_keep_the_level():
    drawn = np.random.default_rng(0).uniform(size=(4000, 3))
    assert np.mean([combined(*each) < 0.05 for each in drawn]) == pytest.approx(0.05, abs=0.01)


def bent(*vector, told=(0.0, 0.0, 0.0)):
    names = ("modulus", "tool.radius", "exponent")
    model = SimpleNamespace(problem=SimpleNamespace(shapes=names))
    precision = np.array([0.1, 400.0, 1e4])
    return SimpleNamespace(model=model, vector=np.array(vector), prior_mean=np.array(told), precision=precision)


@pytest.mark.parametrize(
    ("missed", "bends", "expected"), [(True, 0.0, True), (False, 0.0, False), (True, -0.05, False)]
)
def test_a_base_that_bends_too_far_to_miss_nothing_is_amiss(monkeypatch, missed, bends, expected):
    monkeypatch.setattr(disagreement, "misses_nothing", lambda fitted: missed)
    assert nothing_amiss(bent(0.0, 0.0, bends)) is expected


def test_a_base_is_strained_by_its_priors_and_the_modulus_is_free():
    assert strained(bent(9.0, 0.0, 0.0)) == 1.0
    assert strained(bent(0.0, 0.1, 0.0)) == pytest.approx(2 * 2 * 0.02275, rel=1e-3)  # two of its deviations, two asked
    assert strained(bent(0.0, 0.0, -0.05)) < 1e-5
    assert strained(bent(0.0, 0.1, -0.05, told=(0.0, 0.1, -0.05))) == 1.0  # where it was told to be


def table(means, groups=None):
    cells = tuple(Cell(1, 1, 0, 0, {0: np.ones(4, dtype=bool)}) for _ in means)
    return CellTable(cells, np.array(means, dtype=float), groups)


def trend(means, conditions):
    trials = tuple(SimpleNamespace(number=k, condition=c) for k, c in enumerate(conditions))
    fit = SimpleNamespace(model=SimpleNamespace(problem=SimpleNamespace(trials=trials)))
    return disagreement._trend(fit, table(means))


def test_a_trend_over_trials_is_told_and_a_step_between_conditions_is_none():
    noise = 0.01 * np.random.default_rng(0).normal(size=10)
    rising, stepped = np.arange(10.0) + noise, np.repeat([0.0, 5.0], 5) + noise
    slopes = trend([rising, stepped, noise], [0] * 5 + [1] * 5)
    assert slopes[0] > 2.0 * criteria.TREND
    assert np.abs(slopes[1:]).max() < criteria.TREND


def test_few_trials_without_a_trend_seldom_show_one():
    """Four degrees of freedom: by t itself, 6 is exceeded by one cell in 260."""
    cells = np.random.default_rng(1).normal(size=(2000, 7))
    assert np.mean(np.abs(trend(cells, [0] * 4 + [1] * 3)) > criteria.TREND) < 1e-3


@pytest.mark.parametrize(("z", "told"), [(4.1, True), (-4.1, True), (3.9, False)])
def test_trials_that_change_in_order_are_told_of(z, told):
    made = Detection(table([np.zeros(4)]), None, 1.0, 1.0, np.array([0.0, z]))
    assert bool(exchangeable(made)) is told
    assert exchangeable(Detection(table([]), None, 1.0, 1.0, np.array([]))) == ()


@pytest.mark.parametrize(("rate", "large"), [(1e-4, False), (1e-3, True)])
def test_what_is_sure_but_small_is_seen_and_is_no_disagreement_by_itself(session_of, rate, large):
    """A drift of 0.6 or 6 mN in the mean of a cell, of a press to 2.1 N."""
    session = session_of(force=lambda time, depth, elastic: elastic + rate * (time - time[0]), noise=1e-4, trials=4)
    found = detect(calibrate(session, prepare(session, 90)).base, Settings())
    assert found.p < 0.05
    assert (found.p_cells < 0.05) is large


def test_the_smallest_visible_disagreement_is_that_of_a_channels_best_cell():
    rows = {0: np.ones(4, dtype=bool)}
    cells = tuple(Cell(1, 1, 0, signal, rows) for signal in (0, 0, 1, 2))
    test = FlipTest(np.zeros(4), np.ones(4), 3.0, np.array([0.1, 0.05, 2e-6, 1e-6]), 1.0)
    least = np.array([0.0, 0.0, 5e-6, 1e-6])
    made = Detection(CellTable(cells, np.zeros((4, 6)), least=least), test, 1.0, 1.0, np.zeros(4))
    study = SimpleNamespace(channels=("force_z", "marker_radial", "marker_radial"))
    fit = SimpleNamespace(model=SimpleNamespace(problem=SimpleNamespace(study=study)))
    assert smallest_visible(fit, made) == pytest.approx({"force_z": 0.15, "marker_radial": 4e-6})


def ringing(time, depth, elastic):
    return elastic + 0.008 * np.sin(2.0 * np.pi * 3.0 * (time - time[0])) * (depth > 0.0)


def test_what_changes_its_sign_within_a_phase_is_shared_though_no_cell_shows_it(session_of):
    session = session_of(force=ringing, noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 220)).base
    assert detect(base, Settings()).p_cells > 0.05
    assert shared_misfit(base) > criteria.SHARED
    assert shared_by_chance(base, Settings()) < 0.05
    told = {(place.channel, place.phase) for place in shared_places(base, Settings())}
    assert ("force_z", "hold") in told
    assert ("force_z", "after_lift_off") not in told


def test_a_phase_of_which_no_row_has_samples_of_all_trials_is_no_place(session_of):
    session = session_of(force=ringing, noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 220)).base
    shown = len(shared_places(base, Settings()))
    hold = [c.phase == PHASES.index("hold") for c in base.model.problem.study.conditions]
    for number, rows in enumerate(hold):
        mine = [trial for trial in base.model.problem.trials if trial.condition == number]
        for k, trial in enumerate(mine):
            trial.count[np.flatnonzero(rows)[k % 2 :: 2]] = 0.0
    told = shared_places(base, Settings())
    assert len(told) < shown
    assert all(place.size > 0.0 and place.phase != "hold" for place in told)


def test_noise_alone_is_not_shared(session_of):
    session = session_of(noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    rows = sum(trial.signals.size for trial in base.model.problem.trials[::4])
    assert shared_misfit(base) == pytest.approx(0.0, abs=6.0 * np.sqrt(2.0 * rows))
    assert shared_by_chance(base, Settings()) > 0.05
    assert shared_places(base, Settings()) == ()


def with_residuals(residuals, conditions, scale=1.0):
    """A fit of trials of one signal that misses by white residuals (R, n), with noise of `scale` N."""
    around = SimpleNamespace(peak_force=1.0)
    study = SimpleNamespace(
        channels=("force_z",), conditions=tuple(SimpleNamespace(around=around) for _ in set(conditions))
    )
    trials = tuple(SimpleNamespace(condition=number) for number in conditions)
    noise = SimpleNamespace(scale=np.full((len(trials), 1), scale))
    problem = SimpleNamespace(trials=trials, study=study, noise=noise)
    return SimpleNamespace(
        rows=[np.asarray(each, dtype=float) for each in residuals], model=SimpleNamespace(problem=problem)
    )


@pytest.fixture
def known_rows(monkeypatch):
    """Fits give the residuals that they were made with."""
    white = lambda problem: SimpleNamespace(residuals=lambda rows: rows)  # noqa: E731
    monkeypatch.setattr(disagreement, "White", white)

    def make(*args, **options):
        fit = with_residuals(*args, **options)
        fit.model.signals = lambda vector, nuisance: fit.rows
        fit.vector = fit.nuisance = None
        return fit

    return make


def test_what_is_shared_is_the_mean_above_what_replicates_leave_it(known_rows):
    rows = np.random.default_rng(0).normal(size=(5, 300))
    shared = 5.0 * np.sum(rows.mean(axis=0) ** 2) - rows.var(axis=0, ddof=1).sum()
    assert shared_misfit(known_rows(rows, [0] * 5)) == pytest.approx(shared)
    alone = np.sum(rows[:1] ** 2) - 300.0
    both = known_rows([*rows, *rows[:1]], [0] * 5 + [1])
    assert shared_misfit(both) == pytest.approx(shared + alone)


def test_noise_below_what_is_too_small_to_matter_does_not_make_it_sure(known_rows):
    rows = np.tile(np.full(300, 3.0), (6, 1))
    assert shared_misfit(known_rows(rows, [0] * 6)) == pytest.approx(6 * 300 * 9.0)
    least = criteria.TOO_SMALL * criteria.TOLERANCE_FORCE
    assert shared_misfit(known_rows(rows, [0] * 6, scale=0.01 * least)) == pytest.approx(6 * 300 * 9.0e-4)


def test_trials_of_noise_share_by_chance_at_the_level(known_rows):
    rng = np.random.default_rng(1)
    p = [shared_by_chance(known_rows(rng.normal(size=(8, 40)), [0] * 4 + [1] * 4), Settings()) for _ in range(400)]
    assert np.mean(np.array(p) < 0.05) == pytest.approx(0.05, abs=0.025)
