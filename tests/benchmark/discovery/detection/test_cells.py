"""The sign-flip test of whole trials keeps its level; the size of a misfit is held against a stated tolerance."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.cells import (
    Cell,
    CellTable,
    channel_sizes,
    flip_test,
    least_p,
    misses_nothing,
    one_sided,
    reachable,
)
from benchmark.discovery.discovery_result import PHASES

TRIALS, CELLS = 8, 24
LOAD, HOLD = PHASES.index("load"), PHASES.index("hold")


def table(means):
    rows = {0: np.ones(2, dtype=bool)}
    return CellTable(tuple(Cell(k % 6, 1, 0, k % 3, rows) for k in range(len(means))), means)


def null_means(rng):
    """Cells of one trial resemble each other, and trials scatter differently."""
    shared = rng.standard_t(4, TRIALS) * rng.uniform(0.5, 2.0, TRIALS)
    return 0.7 * shared[None] * rng.normal(1.0, 0.4, (CELLS, 1)) + rng.standard_t(4, (CELLS, TRIALS))


def alarm_rate(sessions, seed):
    rng = np.random.default_rng(seed)
    return np.mean([flip_test(table(null_means(rng)), 0, 0).p_any < 0.05 for _ in range(sessions)])


def test_false_alarms_are_few():
    assert 0.0 < alarm_rate(150, 1) < 0.1


@pytest.mark.slow
def test_false_alarms_stay_at_their_level():
    assert 0.03 <= alarm_rate(1500, 2) <= 0.07


def session_means(rng, trials=10, rows=240):
    """Cell means of a session of nulls: trials whose gains scatter by a tenth, remembered heavy-tailed noise."""
    shape = np.clip(np.minimum(np.arange(rows), rows - np.arange(rows)) / 80.0, 0.0, 1.0)
    columns = np.column_stack([np.ones(rows), shape])
    residuals = []
    for _ in range(trials):
        shocks = rng.standard_t(4, rows) * rng.uniform(0.7, 1.4)
        noise = lfilter([1.0], [1.0, -0.85], shocks)
        measured = np.exp(rng.normal(0.0, 0.1)) * 40.0 * shape + rng.normal(0.0, 2.0) + noise
        residual = measured - 40.0 * shape
        residuals.append(residual - columns @ np.linalg.lstsq(columns, residual, rcond=None)[0])
    return np.array(residuals).reshape(trials, 24, -1).mean(axis=2).T


def session_alarm_rate(sessions, seed):
    rng = np.random.default_rng(seed)
    return np.mean([flip_test(table(session_means(rng)), 0, 0).p_any < 0.05 for _ in range(sessions)])


def test_remembered_noise_and_scattered_gains_give_few_false_alarms():
    assert session_alarm_rate(60, 3) < 0.15


@pytest.mark.slow
def test_remembered_noise_and_scattered_gains_keep_the_level():
    assert 0.03 <= session_alarm_rate(1000, 4) <= 0.07


def test_a_shift_in_one_cell_is_found_there():
    rng = np.random.default_rng(5)
    means = null_means(rng)
    means[7] += 8.0
    test = flip_test(table(means), 0, 0)
    assert test.p_any < 0.05
    assert np.argmin(test.p) == 7


def test_a_shift_that_is_too_small_to_matter_is_none():
    means = null_means(np.random.default_rng(5))
    means[7] += 8.0
    plain = flip_test(table(means), 0, 0)
    size = abs(plain.t[7]) * plain.error[7]
    assert size == pytest.approx(abs(means[7].mean()))
    found = {
        share: flip_test(replace(table(means), least=np.full(CELLS, share * size)), 0, 0) for share in (0.0, 0.5, 1.01)
    }
    assert found[0.0].p_any == plain.p_any < 0.05
    assert found[0.5].t[7] == pytest.approx(0.5 * plain.t[7])
    assert (found[1.01].t[7], found[1.01].p_any) == (0.0, 1.0)


def test_few_trials_cannot_reach_the_level():
    rng = np.random.default_rng(6)
    means = 10.0 + rng.normal(size=(CELLS, 5))
    assert flip_test(table(means), 0, 0).p_any == pytest.approx(1 / 16)


def test_many_trials_draw_their_signs_by_seed():
    means = np.random.default_rng(7).normal(size=(4, 20))
    one, two = (flip_test(table(means), 500, 3) for _ in range(2))
    assert one.p == pytest.approx(two.p)


def test_conditions_that_disagree_in_size_do_not_hide_each_other():
    rng = np.random.default_rng(8)
    means = rng.normal(size=(CELLS, 10))
    groups = np.repeat([0, 1], 5)
    means[3] += np.where(groups == 0, 2.0, 14.0)
    base = table(means)
    test = flip_test(CellTable(base.cells, means, groups), 0, 0)
    assert np.argmin(test.p) == 3
    assert test.p[3] < 0.01


def test_matched_numbers_count_from_one_side():
    rng = np.random.default_rng(9)
    base = table(rng.normal(size=(CELLS, 10)))
    along = 6.0 + rng.normal(size=(3, 10))
    found = {sign: flip_test(CellTable(base.cells, base.means, None, sign * along), 0, 0).p_any for sign in (1, -1)}
    assert found[1] < 0.01 < 0.05 < found[-1]


LAYOUTS = [(6,), (5,), (3, 3), (2, 2, 2), (4, 2), (2, 2, 2, 2), (1,) * 6, (12,), (13,)]


@pytest.mark.parametrize("layout", LAYOUTS, ids=str)
def test_no_data_has_a_smaller_p_than_the_least(layout):
    groups = np.repeat(np.arange(len(layout)), layout)
    settings = Settings(flips=200)
    clear = 100.0 + np.random.default_rng(0).normal(size=(1, groups.size))
    p = float(one_sided(clear, groups, settings.flips, 0)[0])
    assert p == pytest.approx(least_p(groups, settings))


def test_a_test_that_cannot_reach_its_level_is_known():
    able = [layout for layout in LAYOUTS if reachable(np.repeat(np.arange(len(layout)), layout), Settings())]
    assert able == [(6,), (3, 3), (4, 2), (2, 2, 2, 2), (12,), (13,)]
    assert not reachable(np.zeros(6, dtype=int), Settings(level=0.01))
    assert reachable(np.zeros(9, dtype=int), Settings(level=0.01))


def fitted(*missed):
    """Trials of one condition with a peak of 8 N whose force misses by `missed` in the hold, N; markers by 10 um."""
    phase, rows = np.array([LOAD, LOAD, HOLD, HOLD]), 4
    condition = SimpleNamespace(
        phase=phase, cycle=np.ones(rows, dtype=int), part=np.zeros(rows, dtype=int), name="one",
        signals=np.zeros((len(missed), rows, 2)), count=np.ones((len(missed), rows, 2)),
        around=SimpleNamespace(peak_force=8.0),
    )  # fmt: skip
    trials = tuple(
        SimpleNamespace(
            condition=0,
            signals=np.column_stack([np.where(phase == HOLD, force, 0.0), np.full(rows, 1e-5)]),
            count=np.ones((rows, 2)),
        )
        for force in missed
    )
    study = SimpleNamespace(conditions=(condition,), channels=("force_z", "marker_x"))
    problem = SimpleNamespace(study=study, trials=trials)
    model = SimpleNamespace(problem=problem, signals=lambda vector, nuisance: [np.zeros((rows, 2))] * len(trials))
    return SimpleNamespace(model=model, vector=None, nuisance=None)


def test_two_newtons_of_eight_are_beyond_the_tolerance_whatever_their_signs():
    shared, apart, small = fitted(2.0, 2.0, 2.0, 2.0), fitted(2.0, -2.0, 2.0, -2.0), fitted(0.1, 0.1, 0.1, 0.1)
    for each in (shared, apart):
        force, marker = channel_sizes(each, small)
        assert (force.channel, force.before, force.after) == ("force_z", pytest.approx(2.0), pytest.approx(0.1))
        assert force.tolerance == pytest.approx(0.16)  # 2 % of the peak force
        assert force.within
        assert (marker.after, marker.tolerance, marker.within) == (pytest.approx(1e-5), 5e-5, True)
        assert not channel_sizes(small, each)[0].within


def of_force(residuals, *, layout=None, condition=None, peak=2.0):
    """A model of force (R, n) N, of trials of so large forces."""
    rows = residuals.shape[1]
    around = SimpleNamespace(
        phase=np.zeros(rows, dtype=int),
        cycle=np.ones(rows, dtype=int),
        part=np.zeros(rows, dtype=int),
        signals=np.zeros((len(residuals), rows, 1)),
        count=np.ones((len(residuals), rows, 1)),
    )
    groups = np.zeros(len(residuals), dtype=int) if condition is None else condition
    largest = np.full((rows, 1), 0.5 * peak)
    largest[-1] = peak
    trials = [
        SimpleNamespace(condition=group, signals=largest, count=np.ones((rows, 1)), left=residual)
        for group, residual in zip(groups.tolist(), residuals, strict=True)
    ]
    study = SimpleNamespace(layout=layout, conditions=(around,) * (groups.max() + 1), channels=("force_z",))
    predicted = [largest - residual[:, None] for residual in residuals]
    model = SimpleNamespace(
        problem=SimpleNamespace(study=study, trials=trials), signals=lambda vector, nuisance: predicted
    )
    return SimpleNamespace(model=model, vector=None, nuisance=None)


@pytest.mark.parametrize(
    ("layout", "missed", "expected"), [(None, 4.9e-3, True), (None, 5.1e-3, False), ("grid", 4.9e-3, False)]
)
def test_a_quarter_of_a_percent_of_the_largest_force_is_nothing_where_force_alone_is_measured(layout, missed, expected):
    assert misses_nothing(of_force(np.full((6, 80), missed), layout=layout)) is expected


def test_what_is_short_or_changes_its_sign_is_not_lost_in_the_mean_of_a_cell():
    """A pull-off of 0.05 N in three rows of 80; a pitch of 0.02 N; each is 1 % and more of the largest force."""
    noise = np.random.default_rng(0).normal(0.0, 2e-3, (6, 80))
    pull, pitch = np.zeros(80), 0.02 * np.sin(2.0 * np.pi * np.arange(80) / 8.0)
    pull[40:43] = -0.05
    assert misses_nothing(of_force(noise))
    for missed in (pull, pitch):
        assert abs(missed.mean()) < 5e-3
        assert not misses_nothing(of_force(noise + missed))
        other = np.repeat([0, 1], 3)
        assert not misses_nothing(of_force(noise + np.outer(other, missed), condition=other))


def test_a_run_of_rows_shows_what_no_row_does():
    """0.02 N in eight rows, where trials scatter by 0.02 N a row."""
    noise, low = np.random.default_rng(1).normal(0.0, 0.02, (6, 80)), np.zeros(80)
    low[40:48] = -0.02
    assert misses_nothing(of_force(noise))
    assert not misses_nothing(of_force(noise + low))


def test_noise_of_trials_is_no_miss():
    """30 sessions of 0.5 % of the largest force a row; the mean of a cell of each trial is a tenth of that."""
    rng = np.random.default_rng(2)
    assert all(misses_nothing(of_force(rng.normal(0.0, 0.01, (6, 400)))) for _ in range(30))


def test_of_one_trial_it_is_not_known_what_it_scatters_by():
    noise = np.random.default_rng(3).normal(0.0, 0.01, (1, 400))
    assert misses_nothing(of_force(noise))
