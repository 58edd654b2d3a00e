import numpy as np
import pytest

from reports.figures import TrialCurve
from reports.figures.trials import by_condition, loading_median


def trial(peak=2.0, factor=1.0, rows=81, name="t", condition="c", model=True):
    depth = peak * (1 - np.abs(np.linspace(-1, 1, rows)))
    force = factor * depth**2
    return TrialCurve(name, condition, depth, force, 0.5 * force if model else None)


def force(curve):
    return curve.force_N


def test_loading_ends_where_the_depth_first_comes_near_its_largest():
    depth = np.concatenate((np.linspace(0, 1, 11), 0.999 * np.ones(5), np.linspace(1, 0, 11)))
    assert TrialCurve("t", "c", depth, depth).loading() == slice(0, 11)


def test_the_median_of_one_trial_is_its_loading():
    depth, median = loading_median([trial()], force)
    assert (depth[0], depth[-1]) == (0.0, 2.0)
    assert np.allclose(median, depth**2, atol=1e-3)


def test_the_median_is_that_of_the_trials_that_reach():
    trials = [trial(factor=factor) for factor in (1, 2, 3, 4)] + [trial(peak=1.0, factor=100)]
    depth, median = loading_median(trials, force)
    assert depth[-1] == pytest.approx(1.0)
    assert median == pytest.approx(3 * depth**2, abs=2e-2)
    depth, median = loading_median([*trials, trial(factor=2.5)], force)
    assert depth[-1] == pytest.approx(2.0)
    assert median == pytest.approx(2.5 * depth**2, abs=1e-2)


def test_unloading_and_backward_steps_do_not_count():
    depth = np.array([0, 1, 0.9, 2, 3, 2, 1, 0.0])
    measured = np.array([0, 1, 5, 2, 3, -9, -9, -9.0])
    grid, median = loading_median([TrialCurve("t", "c", depth, measured)], force)
    assert median == pytest.approx(grid)


def test_a_series_no_trial_has_gives_nothing():
    grid, median = loading_median([trial(model=False)], lambda curve: curve.fem_force_N)
    assert grid.size == median.size == 0


def test_a_model_with_gaps_keeps_what_it_has():
    curve = trial()
    gappy = np.where(curve.depth_mm > 1.5, np.nan, curve.force_N)
    grid, _ = loading_median(
        [TrialCurve("t", "c", curve.depth_mm, curve.force_N, gappy)], lambda item: item.fem_force_N
    )
    assert grid[-1] == pytest.approx(1.5)


def test_conditions_keep_their_order():
    groups = by_condition(
        [trial(name="1", condition="b"), trial(name="2", condition="a"), trial(name="3", condition="b")]
    )
    assert {name: [item.trial for item in items] for name, items in groups.items()} == {"b": ["1", "3"], "a": ["2"]}
    assert list(groups) == ["b", "a"]


def test_a_trial_of_unequal_columns_is_refused_by_name():
    with pytest.raises(ValueError, match=r"trial_7: force_N has shape \(1,\), allowed: \(2,\)"):
        TrialCurve("trial_7", "c", [0, 1], [0])
