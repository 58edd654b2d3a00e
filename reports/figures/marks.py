"""Marks several figures share: a model's line and where it stopped, and reference lines with their names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.figures.arrays import Floats, stopped_at
from reports.figures.style import MUTED, PAPER, Stroke

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DOTTED = (0, (1, 2))


def model_line(axes: Axes, x: Floats, y: Floats, stroke: Stroke, stops: bool = True) -> None:
    """Draw a model's line, with a cross where only NaN follows because the model stopped.

    Without `stops`, NaN at the end means that there is nothing to draw, not that the model stopped.
    """
    axes.plot(x, y, color=stroke.colour, linestyle=stroke.line, label=stroke.label, zorder=3)
    last = stopped_at(y) if stops else None
    if last is not None:
        stop_mark(axes, float(x[last]), float(y[last]), stroke)


def stop_mark(axes: Axes, x: float, y: float, stroke: Stroke) -> None:
    """Draw a cross where a model stopped, and say so beside it."""
    axes.plot(
        x,
        y,
        color=stroke.colour,
        marker="X",
        markersize=9,
        markeredgecolor=PAPER,
        linestyle="",
        zorder=4,
    )
    axes.annotate(
        f"{stroke.label} stopped",
        (x, y),
        xytext=(8, 0),
        textcoords="offset points",
        va="center",
        color=stroke.colour,
    )


def planned_line(axes: Axes, y: float, text: str) -> None:
    """Draw a horizontal reference line with its name above its left end."""
    axes.axhline(y, color=MUTED, linewidth=1, linestyle=_DOTTED, zorder=1)
    axes.annotate(
        text,
        (0.01, y),
        xycoords=("axes fraction", "data"),
        xytext=(0, 3),
        textcoords="offset points",
        color=MUTED,
        fontsize="small",
    )


def edge_line(axes: Axes, x: float, text: str) -> None:
    """Draw a vertical reference line with its name along it."""
    axes.axvline(x, color=MUTED, linewidth=1, linestyle=_DOTTED, zorder=1)
    axes.annotate(
        text,
        (x, 0.04),
        xycoords=("data", "axes fraction"),
        xytext=(3, 0),
        textcoords="offset points",
        rotation=90,
        va="bottom",
        color=MUTED,
        fontsize="small",
    )
