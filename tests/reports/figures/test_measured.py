import numpy as np
import pytest

from reports.figures import TrialCurve, measured

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
