import numpy as np
import pytest

from reports.figures import profile

RADIUS = np.linspace(0, 20, 30)
FEM = np.array([1 / (1 + RADIUS**2 / 30), 0.7 / (1 + RADIUS**2 / 40)])


def test_each_panel_draws_the_data_of_its_layer(lines, is_drawn):
    figure = profile(["skin", "fat"], RADIUS, FEM, 1.05 * FEM, 5.0)
    for layer, panel in enumerate(figure.panels):
        assert any(is_drawn(line, RADIUS, FEM[layer]) for line in lines(panel.svg, "fem"))
        assert any(is_drawn(line, RADIUS, 1.05 * FEM[layer]) for line in lines(panel.svg, "wave"))


def test_the_press_points_down(lines):
    line = max(lines(profile(["skin", "fat"], RADIUS, FEM).panels[0].svg, "fem"), key=len)
    assert line[0, 1] > line[-1, 1]


def test_the_tool_edge_is_marked_where_it_is_known(texts):
    assert "tool edge" in texts(profile(["skin", "fat"], RADIUS, FEM, None, 5.0).panels[0].svg)
    assert "tool edge" not in texts(profile(["skin", "fat"], RADIUS, FEM).panels[0].svg)


def test_outside_its_window_the_wave_model_has_no_line_and_did_not_stop(lines, texts):
    wave = np.where(RADIUS < 12, FEM, np.nan)
    svg = profile(["skin", "fat"], RADIUS, FEM, wave).panels[0].svg
    assert max(len(line) for line in lines(svg, "wave")) == (RADIUS < 12).sum()
    assert "Wave stopped" not in texts(svg)


def test_words_tell_the_largest_difference():
    wave = FEM.copy()
    wave[0, 3] += 0.25
    assert "differ by at most 0.250 mm" in profile(["skin", "fat"], RADIUS, FEM, wave).panels[0].alt


def test_no_radius_is_refused():
    with pytest.raises(ValueError, match="radius_mm is empty"):
        profile(["skin"], [], np.empty((1, 0)))
