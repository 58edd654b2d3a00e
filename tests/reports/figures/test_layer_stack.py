import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reports.figures import StackLayer, ToolShape, layer_stack
from reports.figures.layer_stack import CrossSection, spread

SKIN = [StackLayer("epidermis", 0.1, 1500.0), StackLayer("dermis", 1.6, 300.0), StackLayer("fat", 10.0, 3.2)]


def test_every_layer_is_named_with_thickness_and_stiffness(texts):
    found = texts(layer_stack(SKIN, ToolShape(5.0)).panels[0].svg)
    assert {"epidermis", "0.1 mm, E = 1.5 MPa", "dermis", "1.6 mm, E = 300 kPa", "fat", "10 mm, E = 3.2 kPa"} <= set(
        found
    )
    assert "tool, radius 5 mm" in found


def test_layers_are_drawn_to_scale(lines):
    svg = layer_stack(SKIN, ToolShape(5.0)).panels[0].svg
    levels = sorted({line[0, 1] for line in lines(svg, "tissue") if len(line) == 2})
    assert len(levels) == 3
    assert (levels[2] - levels[0]) / (levels[1] - levels[0]) == pytest.approx(17, rel=0.02)


def test_width_and_depth_have_one_scale_where_that_makes_a_picture():
    assert CrossSection.of(SKIN, ToolShape(5.0), "bonded", None).stretch == pytest.approx(1.0)
    assert "vertical scale" not in layer_stack(SKIN, ToolShape(5.0)).caption


def test_a_stretched_picture_says_so():
    figure = layer_stack([StackLayer("silicone", 4.0, 45.0)], ToolShape(5.0), "hole", 30.0)
    assert re.search(r"The vertical scale is 7\.\d times the horizontal one\.", figure.caption)
    assert "hole of 30 mm radius" in figure.caption


def test_many_thin_layers_get_a_picture_tall_enough_for_their_names(texts):
    many = [StackLayer(f"a layer of number {number}", 0.1, 10.0 + number) for number in range(12)]
    assert CrossSection.of(many, ToolShape(5.0), "bonded", None).picture_height > 12 * 40
    assert "a layer of number 11" in texts(layer_stack(many, ToolShape(5.0)).panels[0].svg)


def test_a_long_name_is_cut_in_the_picture_but_not_in_words(texts):
    name = "reticular dermis of the volar forearm"
    panel = layer_stack([StackLayer(name, 1.0, 10.0)], ToolShape(5.0)).panels[0]
    assert "reticular dermis of…" in texts(panel.svg)
    assert name in panel.alt


def test_the_tool_is_drawn_and_called_as_it_is():
    rounded = layer_stack(SKIN, ToolShape(5.0, 1.0, np.radians(8.0))).panels[0]
    assert "A tool of 5 mm radius (flat, its edge rounded to 1 mm, tilted by 8°)" in rounded.alt
    assert rounded.svg != layer_stack(SKIN, ToolShape(5.0)).panels[0].svg
    assert "(spherical)" in layer_stack(SKIN, ToolShape(5.0, 5.0)).panels[0].alt


def test_stiffer_layers_have_a_stronger_colour():
    svg = layer_stack(SKIN, ToolShape(5.0)).panels[0].svg
    shades = [float(value) for value in re.findall(r"fill: var\(--tissue, [^)]+\); opacity: ([\d.]+)", svg)]
    assert len(shades) == 3
    assert shades == sorted(shades, reverse=True)


def test_an_endless_layer_is_called_so(texts):
    figure = layer_stack([StackLayer("muscle", None, 12.0)], ToolShape(5.0), "half_space")
    assert "endless, E = 12 kPa" in texts(figure.panels[0].svg)
    assert figure.caption.endswith("the last layer is endless.")


def test_a_half_space_ignores_the_thickness_of_its_last_layer():
    deep = CrossSection.of([*SKIN[:2], StackLayer("fat", 1e4, 3.2)], ToolShape(5.0), "half_space", None)
    assert deep.depth < 50


@given(st.lists(st.floats(0, 100), min_size=1, max_size=12), st.floats(0.1, 8))
def test_labels_never_stand_on_each_other_and_stay_inside(wanted, gap):
    places = spread(np.sort(wanted), gap, -5.0, 105.0)
    assert (np.diff(places) >= gap - 1e-9).all()
    assert places[0] >= -5.0
    assert places[-1] <= 105.0 + 1e-9


def test_labels_with_room_stay_where_they_belong():
    wanted = np.array([0.0, 5.0, 12.0])
    assert np.allclose(spread(wanted, 4.0, -1.0, 13.0), wanted)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([], ToolShape(5.0)), "layers is empty"),
        ((SKIN, ToolShape(0.0)), "tool_radius_mm is 0.0; allowed: above 0"),
        ((SKIN, ToolShape(5.0), "floating"), "support is 'floating'; allowed: bonded, hole, half_space"),
        ((SKIN, ToolShape(5.0), "hole"), "needs hole_radius_mm"),
        (([StackLayer("a", -1.0, 1.0)], ToolShape(5.0)), "thickness_mm of a is -1.0"),
        (([StackLayer("a", 1.0, float("nan"))], ToolShape(5.0)), "youngs_modulus_kPa of a is nan"),
        (
            ([StackLayer("a", None, 1.0), StackLayer("b", 1.0, 1.0)], ToolShape(5.0)),
            "only the last layer may be endless",
        ),
    ],
)
def test_what_cannot_be_drawn_is_refused(arguments, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        layer_stack(*arguments)
