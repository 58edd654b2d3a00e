"""Candidates ranked by their evidence: the held-out gain with its interval, or the share of the gap they close."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from reports.blocks import Figure
from reports.figures.style import FEM, INK, MUTED, WIDE, draw
from reports.formatting import format_number, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_TWO_SIDED = 1.96


@dataclass(frozen=True)
class RankedCandidate:
    """A candidate and its evidence; NaN or None where there is none.

    Attributes
    ----------
    name
        Of one effect, or of several together.
    gain, standard_error
        Held-out gain in log density a trial, and its standard error over trials.
    z
        Their ratio.
    delta_bic
        Negative speaks for it.
    gap_closed
        Share of the explainable gap on held-out data.
    chosen
        Whether it is part of the answer.
    """

    name: str
    gain: float
    standard_error: float
    z: float
    delta_bic: float
    gap_closed: float | None
    chosen: bool = False

    def text(self) -> str:
        """The evidence in words."""
        parts = [] if math.isnan(self.z) else [f"z {format_number(self.z, 3, trim=True)}"]
        parts.append(f"ΔBIC {format_number(float(f'{self.delta_bic:.3g}'), 3, trim=True)}")
        if self.gap_closed is not None:
            parts.append(f"closes {round(100 * self.gap_closed, 1):g} %".replace("-0 %", "0 %").replace("-", "−"))
        return ", ".join(parts)


def ranking(candidates: Sequence[RankedCandidate]) -> Figure:
    """Draw a row a candidate, in the order given.

    The bars are 95 % intervals of the held-out gain over trials; where no candidate has a gain, the dots show the
    share of the gap closed.

    Raises
    ------
    ValueError
        Without a candidate.
    """
    if not candidates:
        raise ValueError("candidates is empty; at least one is needed")
    gains = any(math.isfinite(each.gain) for each in candidates)

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots()
        axes.axvline(0, color=MUTED, linewidth=0.9)
        for row, candidate in enumerate(candidates):
            _paint_row(axes, row, candidate, gains)
        axes.set_yticks(range(len(candidates)), [shortened(each.name, 27) for each in candidates], color=INK)
        axes.set_ylim(len(candidates) - 0.4, -0.6)
        axes.grid(visible=False, axis="y")
        axes.set_xlabel("held-out gain in log density, a trial" if gains else "share of the gap closed (%)")
        axes.locator_params(axis="x", nbins=4)

    words = "; ".join(f"{each.name}: {each.text()}" for each in candidates) + "."
    caption = (
        "Held-out gain of each candidate with its 95\N{NO-BREAK SPACE}% interval over trials; "
        "filled: part of the answer."
        if gains
        else "Share of the gap that each candidate closes on held-out data; filled: part of the answer."
    )
    return Figure.of(draw(paint, WIDE, 76 + 30 * len(candidates)), caption, words, "Candidates")


def _paint_row(axes: Axes, row: int, candidate: RankedCandidate, gains: bool) -> None:
    colour = FEM.colour if candidate.chosen else MUTED
    value = candidate.gain if gains else 100 * (math.nan if candidate.gap_closed is None else candidate.gap_closed)
    if gains and math.isfinite(candidate.standard_error):
        reach = _TWO_SIDED * candidate.standard_error
        axes.plot((value - reach, value + reach), (row, row), color=colour, linewidth=2.2, alpha=0.6)
    if math.isfinite(value):
        face = colour if candidate.chosen else "none"
        axes.plot(value, row, marker="o", markersize=8, markeredgewidth=1.6, color=colour, markerfacecolor=face)
    axes.annotate(
        candidate.text(), (1.03, row), xycoords=("axes fraction", "data"), va="center", color=INK, fontsize="small"
    )
