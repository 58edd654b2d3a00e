import numpy as np
import pytest

from reports.figures import TrialCurve, measured
from reports.figures.measured import by_condition, loading_median


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


DEPTH = np.concatenate((np.linspace(0, 2, 40), np.linspace(2, 0, 40)))
FORCE = DEPTH**2


def trials(count, condition="c", **models):
    return [TrialCurve(f"t{number}", condition, DEPTH, (1 + 0.1 * number) * FORCE, **models) for number in range(count)]


def test_every_trial_is_drawn_and_their_median(lines):
    svg = measured(trials(7)).panels[0].svg
    assert len(lines(svg, "trial")) == 7
    assert any(len(line) > 40 for line in lines(svg, "measured"))


def test_the_models_and_the_residuals_are_drawn(lines, texts):
    svg = measured(trials(3, fem_force_N=FORCE, wave_force_N=0.5 * FORCE)).panels[0].svg
    assert {"residual (N)", "FEM", "Wave", "Median"} <= set(texts(svg))
    long = [line for line in lines(svg, "fem") if len(line) > 20]
    assert len(long) == 1 + 3 + 1


def test_a_residual_is_measured_minus_model(lines):
    svg = measured(trials(1, fem_force_N=FORCE - 1.0 - 0.2 * np.sin(9 * DEPTH))).panels[0].svg
    zero = lines(svg, "muted")
    residual = lines(svg, "fem")[-1]
    level = [line for line in zero if len(line) == 2 and line[0, 1] == line[1, 1]]
    assert any(residual[:, 1].max() < line[0, 1] for line in level)


def test_one_trial_is_its_own_curve(texts):
    found = texts(measured(trials(1)).panels[0].svg)
    assert "Measured" in found
    assert "Median" not in found
    assert "c, 1 trial" in found
    assert "median" not in measured(trials(1)).caption


def test_conditions_have_panels_of_their_own(texts):
    figure = measured(trials(2, "dry") + trials(3, "wet"))
    assert [panel.title for panel in figure.panels] == ["dry", "wet"]
    assert "(b) wet, 3 trials" in texts(figure.panels[1].svg)


def test_synthetic_trials_are_called_so(texts):
    figure = measured(trials(2), synthetic=True)
    assert figure.caption.startswith("Synthetic trials.")
    assert "c, 2 synthetic trials" in texts(figure.panels[0].svg)


def test_words_tell_forces_at_the_same_depth():
    alt = measured(trials(3, fem_force_N=FORCE)).panels[0].alt
    assert alt == "c: 3 trials, median force 4.40 N at 2.00 mm; FEM 4.00 N at 2.00 mm."


def test_forty_trials_of_many_rows_stay_small():
    generator = np.random.default_rng(0)
    depth = np.concatenate((np.linspace(0, 2, 5000), np.linspace(2, 0, 5000)))
    many = [
        TrialCurve(str(n), "c", depth, depth**2 + generator.normal(size=10_000), depth**2, depth) for n in range(40)
    ]
    assert len(measured(many).panels[0].svg) < 700_000


def test_no_trial_is_refused():
    with pytest.raises(ValueError, match="trials is empty"):
        measured([])
