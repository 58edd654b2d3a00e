"""How much of a gap closed: what was left before, what is left after, and the floor below which nothing is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from reports.blocks import Figure
from reports.figures.repaired import AFTER, BEFORE
from reports.figures.style import INK, WIDE, draw
from reports.formatting import format_number, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


@dataclass(frozen=True)
class Gap:
    """Root mean squares in `unit`; the floor is None where there are no replicates."""

    name: str
    before: float
    after: float
    floor: float | None
    unit: str

    def text(self) -> str:
        """Before and after in words."""
        return f"{format_number(self.before, 3)} → {format_number(self.after, 3)} {self.unit}"


def gap_bars(gaps: Sequence[Gap], held_out: str) -> Figure:
    """Draw a pair of bars a gap, in % of what was left before.

    Parameters
    ----------
    gaps
        At least one, each with `before` above zero.
    held_out
        What the values were taken on, in words.

    Raises
    ------
    ValueError
        Without a gap, or where nothing was left before.
    """
    if not gaps or not all(gap.before > 0 for gap in gaps):
        raise ValueError("gaps: at least one is needed, each with something left before")

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots()
        for row, gap in enumerate(gaps):
            _paint_row(axes, row, gap)
        axes.set_yticks(range(len(gaps)), [shortened(gap.name, 24) for gap in gaps], color=INK)
        axes.set_ylim(len(gaps) - 0.4, -0.6)
        axes.set_xlim(0, max(105.0, *(108 * gap.after / gap.before for gap in gaps)))
        axes.set_xlabel("root mean square of measured minus model (% of before)")
        axes.grid(visible=False, axis="y")
        handles, labels = axes.get_legend_handles_labels()
        axes.legend(handles, labels, loc="lower left", bbox_to_anchor=(0, 1), ncols=3)

    floors = any(gap.floor is not None for gap in gaps)
    caption = f"What is left between measurement and model, before and after, on {held_out}"
    caption += "; the line is the floor: the spread of the replicates alone." if floors else "."
    words = "; ".join(f"{gap.name}: {gap.text()}{_floor(gap)}" for gap in gaps) + "."
    return Figure.of(draw(paint, WIDE, 100 + 52 * len(gaps)), caption, words, "The gap")


def _paint_row(axes: Axes, row: int, gap: Gap) -> None:
    label = row == 0
    for value, stroke, offset in ((gap.before, BEFORE, -0.17), (gap.after, AFTER, 0.17)):
        axes.barh(
            row + offset, 100 * value / gap.before, height=0.3, color=stroke.colour, alpha=0.75, linewidth=0,
            label=stroke.label if label else None,
        )  # fmt: skip
    if gap.floor is not None:
        x = 100 * gap.floor / gap.before
        axes.plot((x, x), (row - 0.4, row + 0.4), color=INK, linewidth=1.8, label="Floor" if label else None)
    axes.annotate(gap.text(), (1.03, row), xycoords=("axes fraction", "data"), va="center", color=INK, fontsize="small")


def _floor(gap: Gap) -> str:
    return "" if gap.floor is None else f", floor {format_number(gap.floor, 3)} {gap.unit}"
