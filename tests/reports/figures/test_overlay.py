"""Lines of several runs over each other."""

import numpy as np
import pytest

from reports.figures.overlay import LOOKS, overlay

X = np.linspace(0.0, 1.0, 5)


def test_a_panel_a_layer_and_every_run_by_name() -> None:
    lines = {"a, FEM": (X, 2 * X), "b, FEM": (X, np.full(5, np.nan))}
    figure = overlay({"skin": lines, "fat": lines}, "time (s)", "deflection (mm)", "caption", "title")
    assert [panel.title for panel in figure.panels] == ["skin", "fat"]
    for panel in figure.panels:
        assert "a, FEM" in panel.svg
        assert "b, FEM" in panel.svg
        assert "a, FEM 2.000; b, FEM without values" in panel.alt


def test_looks_differ_in_more_than_colour() -> None:
    assert len(set(LOOKS)) == len(LOOKS)
    assert len({dash for _, dash in LOOKS}) == 3


def test_nothing_to_draw_and_ragged_lines_are_refused() -> None:
    with pytest.raises(ValueError, match="at least one panel"):
        overlay({}, "x", "y", "c", "t")
    with pytest.raises(ValueError, match="shape"):
        overlay({"skin": {"a": (X, X[:3])}}, "x", "y", "c", "t")
