"""The figures of a discovery: traces before and after, the map, the ranking, the gap."""

import math

import numpy as np
import pytest

from reports.figures import (
    Disagreement,
    GapRow,
    RankedCandidate,
    RepairedTrace,
    gap_bars,
    ranking,
    repaired,
    where_map,
)

TIME = np.linspace(0.0, 3.0, 40)
TRACE = RepairedTrace("trial 1", TIME, np.sin(TIME), 0.8 * np.sin(TIME), np.sin(TIME), 0.01 + 0 * TIME, "force", "N")
HOLD = Disagreement("press force", "hold", 1, (1.5, 2.0), -8.1, "−0.21 N", 0.002)
BEST = RankedCandidate("stiffening", 41.0, 5.0, 8.2, -120.0, 0.97, chosen=True)


def test_before_and_after_are_drawn_with_their_residuals(lines, is_drawn) -> None:
    svg = repaired([TRACE]).panels[0].svg
    assert any(is_drawn(line, TIME, 0.8 * np.sin(TIME)) for line in lines(svg, "wave"))
    assert any(is_drawn(line, TIME, 0.2 * np.sin(TIME)) for line in lines(svg, "wave"))
    assert any(is_drawn(line, TIME, np.sin(TIME)) for line in lines(svg, "fem"))


def test_the_words_give_both_residuals() -> None:
    figure = repaired([TRACE], measured="FEM")
    assert "before and 0 N after" in figure.panels[0].alt
    assert "band" in figure.caption
    assert "FEM minus model" in figure.caption


def test_a_model_that_was_not_changed_is_drawn_once(texts) -> None:
    svg = repaired([TRACE], changed=False).panels[0].svg
    assert "Model" in texts(svg)
    assert "After" not in texts(svg)


def test_traces_of_other_lengths_are_refused() -> None:
    with pytest.raises(ValueError, match="before"):
        RepairedTrace("t", TIME, TIME, TIME[1:], TIME, TIME, "force", "N")
    with pytest.raises(ValueError, match="traces is empty"):
        repaired([])


def test_the_map_has_each_field_and_the_value(texts) -> None:
    figure = where_map([HOLD], ["press force"], ["load", "hold"])
    assert {"press force", "load", "hold", "−8.1"} <= set(texts(figure.panels[0].svg))
    assert "1.5 to 2.0 mm: −0.21 N (p = 0.0020)" in figure.panels[0].alt


def test_a_cell_outside_the_map_is_refused() -> None:
    with pytest.raises(ValueError, match="in no row"):
        where_map([HOLD], ["markers"], ["hold"])
    with pytest.raises(ValueError, match="cells is empty"):
        where_map([], [], [])


def test_the_ranking_gives_the_evidence(texts) -> None:
    found = texts(ranking([BEST]).panels[0].svg)
    assert "z 8.2, ΔBIC −120, closes 97 %" in found
    assert "held-out gain in log density, a trial" in found


def test_without_a_gain_the_share_of_the_gap_is_drawn(texts) -> None:
    bare = RankedCandidate("slip", math.nan, math.nan, math.nan, 3.0, None)
    shared = RankedCandidate("stiffening", math.nan, math.nan, math.nan, -9.0, 0.999)
    found = texts(ranking([shared, bare]).panels[0].svg)
    assert "share of the gap closed (%)" in found
    assert "ΔBIC −9, closes 99.9 %" in found
    assert "ΔBIC 3" in found


def test_the_gap_names_both_sizes_and_the_floor(texts) -> None:
    figure = gap_bars([GapRow("press force", 0.21, 0.035, 0.03, "N")], "held-out trials")
    found = texts(figure.panels[0].svg)
    assert {"Before", "After", "Floor", "0.210 → 0.0350 N"} <= set(found)
    assert "floor 0.0300 N" in figure.panels[0].alt
    with pytest.raises(ValueError, match="something left before"):
        gap_bars([GapRow("a", 0.0, 0.0, None, "N")], "x")
