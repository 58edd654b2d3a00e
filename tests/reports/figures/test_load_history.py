import numpy as np
import pytest

from reports.figures import load_history

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
