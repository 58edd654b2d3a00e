import numpy as np
import pytest

from reports.figures import Pair
from reports.figures.parameters import MOST_DOTS, ParameterAxis, over_parameters

X = np.array([50.0, 100.0, 200.0, 400.0])
FEM = np.array([4.0, 3.0, 2.5, 2.2])
WAVE = np.array([4.6, 3.1, np.nan, 2.1])


def figure(axes, **more):
    return over_parameters(axes, {"fem": FEM, "wave": WAVE}, "depth at peak load (mm)", "Depth", **more)


def test_one_parameter_is_a_line_through_its_points(lines, is_drawn) -> None:
    svg = figure([ParameterAxis("dermis.youngs_modulus", X[::-1], "kPa")]).panels[0].svg
    drawn = lines(svg, "fem")
    assert any(is_drawn(line, X, FEM[::-1]) for line in drawn)


def test_several_parameters_have_a_panel_each_without_lines(texts, lines) -> None:
    drawn = figure([ParameterAxis("a.e", X, "kPa"), ParameterAxis("tool.radius", X / 50, "mm")])
    assert [panel.title for panel in drawn.panels] == ["a.e", "tool.radius"]
    assert {"a.e (kPa)", "depth at peak load (mm)", "FEM", "Wave"} <= set(texts(drawn.panels[0].svg))
    assert not any(len(line) == len(X) for line in lines(drawn.panels[0].svg, "fem"))
    assert "vary as well" in drawn.caption


def test_words_stand_side_by_side(texts) -> None:
    drawn = figure([ParameterAxis("tool.contact", ["a", "b", "a", "b"])])
    assert {"a", "b", "tool.contact"} <= set(texts(drawn.panels[0].svg))
    assert drawn.panels[0].alt.startswith("depth at peak load (mm) over tool.contact (a, b): FEM from 2.200 to 4.000")


def test_a_logarithmic_axis_spaces_equal_ratios_equally(lines) -> None:
    svg = figure([ParameterAxis("a.e", X, "kPa", logarithmic=True)]).panels[0].svg
    line = next(line for line in lines(svg, "fem") if len(line) == len(X))
    np.testing.assert_allclose(np.diff(line[:, 0]), np.diff(line[:, 0])[0], atol=0.05)


def test_a_series_of_its_own_has_its_name_and_missing_values_are_said() -> None:
    axes = [ParameterAxis("a.e", X, "kPa")]
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
    [([], {"fem": FEM}), ([ParameterAxis("a", X)], {}), ([ParameterAxis("a", X)], {"fem": FEM[:2]})],
)
def test_what_it_refuses(axes, results) -> None:
    with pytest.raises(ValueError, match=r"empty|shape"):
        over_parameters(axes, results, "x", "X")
