"""Lines of several runs over each other."""

import itertools
import re

import numpy as np
import pytest

from reports.figures import Pair
from reports.figures.studies import LOOKS, MOST_DOTS, ParameterAxis, over_parameters, overlay

X = np.linspace(0.0, 1.0, 5)


def test_a_panel_a_layer_and_every_run_by_name() -> None:
    lines = {"a, FEM": (X, 2 * X), "b, FEM": (X, np.full(5, np.nan))}
    figure = overlay({"skin": lines, "fat": lines}, "time (s)", "deflection (mm)", "caption", "title")
    assert [panel.title for panel in figure.panels] == ["skin", "fat"]
    for panel in figure.panels:
        assert "a, FEM" in panel.svg
        assert "b, FEM" in panel.svg
        assert "a, FEM 2.000; b, FEM without values" in panel.alt


def test_lines_that_lie_on_each_other_show_each_by_its_width(lines) -> None:
    same = {f"{run}, {model}": (X, X) for run in "ab" for model in ("FEM", "wave")}
    (panel,) = overlay({"skin": same}, "time (s)", "deflection (mm)", "caption", "title").panels
    strokes = re.findall(r"stroke: var\(--(\w+),[^\"]*stroke-width: ([\d.]+)", panel.svg)
    drawn = [(of, float(width)) for of, width in strokes if of in ("fem", "wave", "incomplete", "good")][:4]
    assert [of for of, _ in drawn] == ["fem", "incomplete", "wave", "good"]  # both FEM under both waves
    assert [width for _, width in drawn] == sorted({width for _, width in drawn}, reverse=True)
    assert min(wide - narrow for (_, wide), (_, narrow) in itertools.pairwise(drawn)) > 1.5
    live = {line.colour: line.width for line in panel.live.axes[0].lines}
    assert live == dict(drawn)


def test_looks_differ_in_more_than_colour() -> None:
    assert len(set(LOOKS)) == len(LOOKS)
    assert len({dash for _, dash in LOOKS}) == 3


def test_nothing_to_draw_and_ragged_lines_are_refused() -> None:
    with pytest.raises(ValueError, match="at least one panel"):
        overlay({}, "x", "y", "c", "t")
    with pytest.raises(ValueError, match="shape"):
        overlay({"skin": {"a": (X, X[:3])}}, "x", "y", "c", "t")


VALUES = np.array([50.0, 100.0, 200.0, 400.0])
FEM = np.array([4.0, 3.0, 2.5, 2.2])
WAVE = np.array([4.6, 3.1, np.nan, 2.1])


def figure(axes, **more):
    return over_parameters(axes, {"fem": FEM, "wave": WAVE}, "depth at peak load (mm)", "Depth", **more)


def test_one_parameter_is_a_line_through_its_points(lines, is_drawn) -> None:
    svg = figure([ParameterAxis("dermis.youngs_modulus", VALUES[::-1], "kPa")]).panels[0].svg
    drawn = lines(svg, "fem")
    assert any(is_drawn(line, VALUES, FEM[::-1]) for line in drawn)


def test_several_parameters_have_a_panel_each_without_lines(texts, lines) -> None:
    drawn = figure([ParameterAxis("a.e", VALUES, "kPa"), ParameterAxis("tool.radius", VALUES / 50, "mm")])
    assert [panel.title for panel in drawn.panels] == ["a.e", "tool.radius"]
    assert {"a.e (kPa)", "depth at peak load (mm)", "FEM", "Wave"} <= set(texts(drawn.panels[0].svg))
    assert not any(len(line) == len(VALUES) for line in lines(drawn.panels[0].svg, "fem"))
    assert "vary as well" in drawn.caption


def test_words_stand_side_by_side(texts) -> None:
    drawn = figure([ParameterAxis("tool.contact", ["a", "b", "a", "b"])])
    assert {"a", "b", "tool.contact"} <= set(texts(drawn.panels[0].svg))
    assert drawn.panels[0].alt.startswith("depth at peak load (mm) over tool.contact (a, b): FEM from 2.200 to 4.000")


def test_a_logarithmic_axis_spaces_equal_ratios_equally(lines) -> None:
    svg = figure([ParameterAxis("a.e", VALUES, "kPa", logarithmic=True)]).panels[0].svg
    line = next(line for line in lines(svg, "fem") if len(line) == len(VALUES))
    np.testing.assert_allclose(np.diff(line[:, 0]), np.diff(line[:, 0])[0], atol=0.05)


def test_a_series_of_its_own_has_its_name_and_missing_values_are_said() -> None:
    axes = [ParameterAxis("a.e", VALUES, "kPa")]
    error = over_parameters(axes, {"spring bed against FEM": WAVE / FEM}, "error (%)", "Error")
    assert "spring bed against FEM from" in error.panels[0].alt
    nothing = over_parameters(axes, {"fem": np.full(4, np.nan)}, "depth (mm)", "Depth", pair=Pair.named("FEA"))
    assert "FEA without values" in nothing.panels[0].alt


def test_many_points_are_thinned_and_it_is_said() -> None:
    size = 5 * MOST_DOTS
    drawn = over_parameters([ParameterAxis("a", np.arange(size))], {"fem": np.arange(size)}, "x (mm)", "X")
    assert "every 5th point drawn" in drawn.caption
    assert len(drawn.panels[0].svg) < 200_000


@pytest.mark.parametrize(
    ("axes", "results"),
    [([], {"fem": FEM}), ([ParameterAxis("a", VALUES)], {}), ([ParameterAxis("a", VALUES)], {"fem": FEM[:2]})],
)
def test_what_it_refuses(axes, results) -> None:
    with pytest.raises(ValueError, match=r"empty|shape"):
        over_parameters(axes, results, "x", "X")
