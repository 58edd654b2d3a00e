"""Figures call the two models by the names they are given, in legend, caption and description."""

import numpy as np
import pytest

from reports import Figure
from reports.figures import (
    Normal,
    Pair,
    TrialCurve,
    force_depth,
    load_history,
    max_deformation,
    measured,
    normal_fit,
    profile,
    timing,
)

STEP = np.arange(1.0, 13.0)
FEM = np.column_stack([np.sqrt(STEP), STEP**2 / 50])
WAVE = 1.1 * FEM
OWN = Pair.named("FEA of bench.csv", "spring bed")
FITS = [Normal(1.0, 0.5), Normal(2.0, 0.7)]

FIGURES = {
    "max_deformation": lambda: max_deformation(["a", "b"], STEP, FEM, WAVE, 0 * FEM + 10, pair=OWN),
    "profile": lambda: profile(["a", "b"], STEP, FEM.T, WAVE.T, pair=OWN),
    "force_depth": lambda: force_depth(STEP, STEP, STEP, 1.1 * STEP, pair=OWN),
    "load_history": lambda: load_history(STEP, STEP, "force", STEP, 1.1 * STEP, pair=OWN),
    "normal_fit": lambda: normal_fit(["a", "b"], FEM, FITS, WAVE, FITS, pair=OWN),
    "measured": lambda: measured([TrialCurve("t", "c", STEP, STEP, STEP, 1.1 * STEP)], pair=OWN),
    "timing": lambda: timing({"fem": [1.0], "wave": [0.1]}, pair=OWN),
}


def words(figure: Figure) -> str:
    return " ".join([figure.caption, *(panel.alt for panel in figure.panels)])


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_uses_the_given_names(texts, name: str) -> None:
    figure = FIGURES[name]()
    legend = [text for panel in figure.panels for text in texts(panel.svg)]
    assert {"FEA of bench.csv", "spring bed"} <= set(legend)
    assert "wave" not in words(figure).lower()
    assert "FEM" not in words(figure)


def test_without_names_they_are_fem_and_wave() -> None:
    assert Pair.named() == Pair()
    assert Pair().caption(True) == "FEM (solid) and wave model (dashed)"
    assert Pair().caption(False) == "FEM alone; the wave model has no values here"


def test_a_long_name_is_cut_in_the_legend_alone() -> None:
    long = "a spring bed with forty times forty springs"
    pair = Pair.named(wave=long)
    assert pair.wave.name == long
    assert len(pair.wave.label) <= 24
    assert pair.fem == Pair().fem
