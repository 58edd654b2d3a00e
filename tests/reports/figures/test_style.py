import subprocess
import sys

import matplotlib
import numpy as np
import pytest

from reports.figures.style import FEM, SMALL, WAVE, draw, panel_letter


def plot(drawing):
    axes = drawing.subplots()
    axes.plot(np.arange(9), np.arange(9) ** 2, color=FEM.colour, label="<FEM> & $x$")
    axes.plot(np.arange(9), np.arange(9), color=WAVE.colour, linestyle=WAVE.line)
    axes.set(xlabel="load ($\\notmath", ylabel="<i>force</i> (N)")
    axes.legend()


def test_the_same_drawing_is_the_same_bytes():
    assert draw(plot) == draw(plot)


def test_the_same_drawing_is_the_same_bytes_in_another_process():
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); import test_style as t\n"
        "sys.stdout.buffer.write(t.draw(t.plot).encode())"
    )
    folder = __file__.rsplit("test_style", 1)[0]
    ran = subprocess.run([sys.executable, "-c", code, folder], capture_output=True, check=True)
    assert ran.stdout.decode() == draw(plot)


def test_text_stays_text_and_is_never_mathematics(texts):
    assert {"<FEM> & $x$", "load ($\\notmath", "<i>force</i> (N)"} <= set(texts(draw(plot)))


def test_colours_are_variables_with_the_light_shade_as_fallback():
    svg = draw(plot)
    assert f"stroke: var(--fem, {FEM.colour})" in svg
    assert f"stroke: {FEM.colour}" not in svg


def test_a_colour_outside_the_palette_is_refused():
    with pytest.raises(ValueError, match="#123456 is not in the palette"):
        draw(lambda drawing: drawing.subplots().plot([0, 1], color="#123456"))


def test_no_font_and_no_ground_comes_with_a_drawing():
    svg = draw(plot)
    assert "DejaVu" not in svg
    assert "@font-face" not in svg
    assert "font-family" in svg.split(">", 1)[0]
    assert "#ffffff" not in svg


def test_the_natural_size_is_the_one_asked_for():
    assert 'viewBox="0 0 340 200" width="340" height="200"' in draw(plot, SMALL, 200)


def test_settings_of_the_reader_neither_matter_nor_change():
    expected = draw(plot)
    with matplotlib.rc_context({"lines.linewidth": 9.0, "font.size": 30.0, "svg.fonttype": "path"}):
        before = dict(matplotlib.rcParams)
        assert draw(plot) == expected
        assert dict(matplotlib.rcParams) == before


def test_drawing_needs_no_pyplot_and_importing_no_matplotlib():
    code = (
        "import sys, reports.figures as f\n"
        "assert 'matplotlib' not in sys.modules\n"
        "f.force_depth([0, 1], [0, 1])\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_panels_have_letters():
    assert [panel_letter(position) for position in (0, 1, 25, 26, 27, 52)] == ["a", "b", "z", "aa", "ab", "ba"]


def test_every_figure_names_its_axes_with_units(every_figure, texts):
    axes = (
        *("(mm)", "(N)", "(s)", "(ms)", "(%)", "(1/mm)", "(kPa)"),
        *("unknowns", "load step", "wall time (s), logarithmic"),
    )
    for name, figure in every_figure.items():
        for panel in figure.panels:
            labels = [text for text in texts(panel.svg) if text.endswith(axes)]
            assert len(labels) >= (1 if name == "timing" else 2), name


def test_every_figure_is_described(every_figure):
    for name, figure in every_figure.items():
        assert figure.title, name
        assert figure.caption.endswith("."), name
        assert all(len(panel.alt) > 25 and panel.alt.endswith(".") for panel in figure.panels), name
        assert not any("nan" in panel.alt.lower().split() for panel in figure.panels), name


@pytest.mark.parametrize("span", [(0.02, 4e4), (2.0, 8.0), (1e-7, 1e8)])
def test_the_ticks_of_decades_are_numbers_not_mathematics(texts, span):
    def paint(drawing):
        axes = drawing.subplots()
        axes.plot(span, span, color=FEM.colour)
        axes.set(xscale="log", yscale="log")

    svg = draw(paint)
    assert "$" not in svg
    assert "mathdefault" not in svg
    found = [float(text.replace("\u202f", "")) for text in texts(svg) if text and "×" not in text]
    assert all(span[0] / 10 <= value <= span[1] * 10 for value in found)
    assert len(texts(svg)) >= 4


@pytest.mark.parametrize("values", [(-8e-5, 6e-5), (123456.01, 123456.04), (0.0, 4e5)])
def test_no_factor_and_no_offset_stands_beside_an_axis(texts, values):
    def paint(drawing):
        drawing.subplots().plot(values, (0.0, 1.0), color=FEM.colour)

    found = texts(draw(paint))
    assert not [text for text in found if text.startswith(("1e", "+", "×"))]
    plain = [text.replace("−", "-").replace("\u202f", "").replace(" × 10⁻⁵", "e-5") for text in found]
    assert sum(values[0] - 1e-9 <= float(text) <= values[1] + 1e-9 for text in plain) >= 3
