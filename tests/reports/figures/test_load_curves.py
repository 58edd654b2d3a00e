import numpy as np
import pytest

from reports.figures import force_depth, load_history

TIME = np.linspace(0.1, 3, 30)
LOAD = np.sin(TIME)


def test_load_and_answers_are_drawn(lines, is_drawn):
    svg = load_history(TIME, LOAD, "force", LOAD**2, 0.8 * LOAD**2).panels[0].svg
    for colour, values in (("ink", LOAD), ("fem", LOAD**2), ("wave", 0.8 * LOAD**2)):
        assert any(is_drawn(line, TIME, values) for line in lines(svg, colour)), colour


@pytest.mark.parametrize(
    ("control", "above", "below"), [("force", "force (N)", "depth (mm)"), ("depth", "depth (mm)", "force (N)")]
)
def test_the_axes_follow_the_control(texts, control, above, below):
    found = texts(load_history(TIME, LOAD, control, LOAD).panels[0].svg)
    assert found.index(above) < found.index(below)


def test_the_load_alone_is_a_figure(texts):
    found = texts(load_history(TIME, LOAD, "force", np.full(30, np.nan)).panels[0].svg)
    assert "depth (mm)" not in found
    assert "time (s)" in found


def test_a_model_that_stopped_is_named():
    cut = np.where(TIME > 1, np.nan, LOAD)
    assert "The FEM stopped early." in load_history(TIME, LOAD, "force", cut, LOAD).caption


def test_another_control_is_refused():
    with pytest.raises(ValueError, match="control is 'speed'; allowed: force, depth"):
        load_history(TIME, LOAD, "speed")


DEPTH = np.linspace(0, 2, 30)


def test_both_curves_are_drawn(lines, is_drawn):
    svg = force_depth(DEPTH, DEPTH**2, DEPTH, 1.2 * DEPTH**2).panels[0].svg
    assert any(is_drawn(line, DEPTH, DEPTH**2) for line in lines(svg, "fem"))
    assert any(is_drawn(line, DEPTH, 1.2 * DEPTH**2) for line in lines(svg, "wave"))


def test_words_tell_the_peaks():
    assert force_depth(DEPTH, DEPTH**2).panels[0].alt == "FEM reaches 4.00 N at 2.00 mm."


def test_a_missed_peak_is_drawn_and_said(texts):
    figure = force_depth(DEPTH, DEPTH**2, planned_peak_N=5.0)
    assert {"planned 5 N", "FEM stopped"} <= set(texts(figure.panels[0].svg))
    assert "The FEM run stopped at 4.00 N." in figure.caption


def test_a_reached_peak_needs_no_line(texts):
    assert "planned 4 N" not in texts(force_depth(DEPTH, DEPTH**2, planned_peak_N=4.0).panels[0].svg)


def test_a_run_without_any_step_still_draws():
    figure = force_depth([], [], planned_peak_N=5.0)
    assert figure.panels[0].alt == "FEM has no values."


def test_long_histories_are_thinned(lines):
    depth = np.linspace(0, 2, 5000)
    svg = force_depth(depth, depth**2 + 0.01 * np.sin(1e4 * depth)).panels[0].svg
    assert max(len(line) for line in lines(svg, "fem")) <= 240


def test_unequal_columns_are_refused():
    with pytest.raises(ValueError, match="wave_force_N has shape"):
        force_depth(DEPTH, DEPTH, DEPTH, DEPTH[:3])


def test_a_way_back_that_lies_on_the_way_in_is_drawn_once(lines):
    depth, force = np.r_[DEPTH[3:], DEPTH[-2::-1]], np.r_[DEPTH[3:] ** 2, DEPTH[-2::-1] ** 2]
    figure = force_depth(depth, force, depth, 1.2 * force)
    assert "The way back lies on the way in (FEM and wave model)." in figure.caption
    for line, stretch in zip(figure.panels[0].live.axes[0].lines, (1.0, 1.2), strict=True):
        assert np.allclose(line.x, DEPTH)
        assert np.allclose(line.y, stretch * DEPTH**2)
    assert {len(line) for line in lines(figure.panels[0].svg, "fem")} <= {2, 3, len(DEPTH)}  # grid and legend beside it


def test_a_loop_is_drawn_as_a_loop():
    depth, force = np.r_[DEPTH, DEPTH[-2::-1]], np.r_[DEPTH**2, 0.97 * DEPTH[-2::-1] ** 2]
    figure = force_depth(depth, force)
    assert "way back" not in figure.caption
    assert len(figure.panels[0].live.axes[0].lines[0].x) == len(depth)
