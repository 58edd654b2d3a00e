import numpy as np
import pytest

from reports.figures import max_deformation, profile


def test_each_panel_draws_the_data_of_its_layer(ramp, lines, is_drawn):
    step, fem, wave = ramp
    figure = max_deformation(["skin", "fat"], step, fem, wave, 100 * (wave / fem - 1) + step[:, None] ** 2)
    for layer, panel in enumerate(figure.panels):
        assert any(is_drawn(line, step, fem[:, layer]) for line in lines(panel.svg, "fem"))
        assert any(is_drawn(line, step, wave[:, layer]) for line in lines(panel.svg, "wave"))
        error = 100 * (wave / fem - 1)[:, layer] + step**2
        assert any(is_drawn(line, step, error) for line in lines(panel.svg, "ink"))


def test_words_tell_peaks_and_errors(ramp):
    step, fem, wave = ramp
    panel = max_deformation(["skin", "fat"], step, fem, wave, np.tile(np.linspace(-2, 3, 24)[:, None], 2)).panels[0]
    assert panel.alt == (
        "skin: FEM reaches 2.000 mm, wave model 2.200 mm; "
        "the error of wave model against FEM lies between −2.00 and 3.00 percent."
    )


def test_without_a_wave_model_the_fem_stands_alone(ramp, lines):
    step, fem, _ = ramp
    figure = max_deformation(["skin", "fat"], step, fem)
    assert all(lines(panel.svg, "wave") == [] for panel in figure.panels)
    assert "alone" in figure.caption


def test_a_stopped_run_is_marked_and_said(ramp, texts):
    step, fem, wave = ramp
    fem[10:] = np.nan
    panel = max_deformation(["skin", "fat"], step, fem, wave).panels[0]
    assert "FEM stopped" in texts(panel.svg)
    assert panel.alt.endswith("the FEM run stopped before the end.")


def test_a_run_that_stopped_at_once_still_draws(ramp, texts):
    step, fem, wave = ramp
    panel = max_deformation(["skin", "fat"], step, np.full_like(fem, np.nan), wave, np.full_like(fem, np.nan)).panels[0]
    assert "FEM reaches – mm" in panel.alt
    assert "error (%)" not in texts(panel.svg)


def test_layers_of_very_different_size_get_their_own_scale(ramp):
    step, fem, wave = ramp
    assert "own vertical scale" in max_deformation(["skin", "bone"], step, fem * [1, 0.01], wave).caption
    assert "own vertical scale" not in max_deformation(["skin", "fat"], step, fem, wave).caption


def test_names_show_as_they_are(ramp, texts):
    step, fem, _ = ramp
    panel = max_deformation(["<b>$skin$</b>", "fat"], step, fem).panels[0]
    assert "(a) <b>$skin$</b>" in texts(panel.svg)


def test_a_long_name_is_cut_in_the_picture_but_not_in_words(ramp, texts):
    step, fem, _ = ramp
    name = "subcutaneous adipose tissue of the abdominal wall"
    panel = max_deformation([name, "fat"], step, fem).panels[0]
    assert any(text.startswith("(a) subcutaneous adipose") and text.endswith("…") for text in texts(panel.svg))
    assert panel.title == name
    assert panel.alt.startswith(name)


def test_arrays_of_another_shape_are_refused(ramp):
    step, fem, _ = ramp
    with pytest.raises(ValueError, match=r"fem_mm has shape \(24, 2\), allowed: \(24, 1\)"):
        max_deformation(["skin"], step, fem)


RADIUS = np.linspace(0, 20, 30)
FEM = np.array([1 / (1 + RADIUS**2 / 30), 0.7 / (1 + RADIUS**2 / 40)])


def test_each_panel_draws_the_profile_of_its_layer(lines, is_drawn):
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
