import re

import pytest

from reports.palette import PALETTE, contrast, css_variable, stylesheet

TEXT = ("ink", "muted", "link", "good", "finding", "failed", "incomplete", "unknown", "fem", "wave", "measured")
LINES = ("tissue", "tool", "trial")


def test_contrast_is_that_of_the_definition():
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.005)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("ground", ["paper", "raised"])
@pytest.mark.parametrize(("names", "least"), [(TEXT, 4.5), (LINES, 3.0)])
def test_text_and_lines_stand_out(theme, ground, names, least):
    below = getattr(PALETTE[ground], theme)
    ratios = {name: contrast(getattr(PALETTE[name], theme), below) for name in names}
    assert min(ratios.values()) >= least, ratios


def test_every_light_shade_is_one_of_its_own_so_that_it_can_be_swapped():
    shades = [shade.light for shade in PALETTE.values()]
    assert len(set(shades)) == len(shades)
    assert all(re.fullmatch("#[0-9a-f]{6}", shade.light + "") for shade in PALETTE.values())


def test_the_stylesheet_sets_every_colour_in_both_shades():
    light, dark = stylesheet().split("@media screen and (prefers-color-scheme:dark)")
    for name, shade in PALETTE.items():
        assert f"--{name}:{shade.light};" in light
        assert f"--{name}:{shade.dark};" in dark


def test_a_colour_becomes_its_variable():
    assert css_variable(PALETTE["fem"].light.upper()) == f"var(--fem, {PALETTE['fem'].light})"
    assert css_variable("#123456") is None
