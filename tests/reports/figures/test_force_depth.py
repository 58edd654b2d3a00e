import numpy as np
import pytest

from reports.figures import force_depth

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
