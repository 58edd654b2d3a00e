"""The trend of the timed quantities over the checks in the history."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from benchmark.gate.baseline import HistoryEntry
from reports import Figure, Panel
from reports.figures.style import INK, MUTED, SMALL, draw, heading
from reports.palette import PALETTE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

MOST_CHECKS = 100
LEAST_CHECKS = 2
COLOURS = {False: PALETTE["fem"].light, True: PALETTE["failed"].light}
MARKERS = {False: "o", True: "X"}


@dataclass(frozen=True)
class TrendPoint:
    """One check of one quantity, relative to the trend's first: time, interval and limit (None where it has none)."""

    number: int
    ratio: float
    ci95: tuple[float, float] | None
    allowed: float | None

    @property
    def failed(self) -> bool:
        """Whether it was called slower."""
        return self.allowed is not None and self.ratio > self.allowed


@dataclass(frozen=True)
class Trend:
    """A quantity over the checks, oldest first."""

    quantity: str
    points: tuple[TrendPoint, ...]


def trends(history: Sequence[HistoryEntry], machine: str, *, against: bool) -> list[Trend]:
    """Return the trends of the last check's quantities over the checks of one machine and way of comparing.

    A quantity that has fewer than two such checks has none.
    """
    alike = [each for each in history if each.machine == machine and (each.against is not None) == against][
        -MOST_CHECKS:
    ]
    names = list(alike[-1].timing) if alike else []
    found = [Trend(name, _points(name, alike)) for name in names]
    return [each for each in found if len(each.points) >= LEAST_CHECKS]


def trend_figure(found: Sequence[Trend]) -> Figure:
    """Draw one panel a quantity: time relative to the first check, 95 % intervals, limits.

    Parameters
    ----------
    found
        At least one, with at least two checks each.
    """
    panels = [Panel(draw(_Painter(trend).paint, SMALL, 250), _words(trend), trend.quantity) for trend in found]
    caption = (
        "Time in units of its references, relative to the first check shown: a dot a check, with its "
        "95\N{NO-BREAK SPACE}% interval; a short bar is the limit of that check, a cross one that was called slower."
    )
    return Figure(panels, caption, "Trend of the timed quantities")


def _points(name: str, history: Sequence[HistoryEntry]) -> tuple[TrendPoint, ...]:
    entries = [(number, each.timing[name]) for number, each in enumerate(history, start=1) if name in each.timing]
    if not entries:
        return ()
    first = entries[0][1]["ratio"]
    return tuple(
        TrendPoint(
            number,
            each["ratio"] / first,
            None if each["ci95"] is None else (each["ci95"][0] / first, each["ci95"][1] / first),
            None if each["allowed"] is None else each["allowed"] / first,
        )
        for number, each in entries
    )


@dataclass(frozen=True)
class _Painter:
    """One panel."""

    trend: Trend

    def paint(self, drawing: Drawing) -> None:
        """Draw intervals, limits and dots."""
        axes = drawing.subplots()
        for point in self.trend.points:
            _paint(axes, point)
        numbers = np.array([point.number for point in self.trend.points])
        axes.set_xlim(numbers[0] - 0.6, numbers[-1] + 0.6)
        axes.locator_params(axis="x", integer=True)
        axes.set_xlabel("check", color=MUTED)
        axes.set_ylabel("time, first check = 1", color=MUTED)
        heading(axes, self.trend.quantity)


def _paint(axes: Axes, point: TrendPoint) -> None:
    colour = COLOURS[point.failed]
    if point.ci95 is not None:
        axes.plot((point.number, point.number), point.ci95, color=colour, alpha=0.6, linewidth=2.0)
    if point.allowed is not None:
        axes.plot((point.number - 0.4, point.number + 0.4), (point.allowed, point.allowed), color=INK, linewidth=1.2)
    axes.plot(point.number, point.ratio, marker=MARKERS[point.failed], color=colour, markersize=6, linestyle="")


def _words(trend: Trend) -> str:
    """Say what the panel shows."""
    ratios = [point.ratio for point in trend.points]
    failed = sum(point.failed for point in trend.points)
    return (
        f"{trend.quantity} over {len(ratios)} checks, relative to the first: {min(ratios):.3g} to {max(ratios):.3g}, "
        f"last {ratios[-1]:.3g}; {failed} called slower."
    )
