"""Trends over the checks in the history, times and values, with the steps in them marked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from benchmark.gate.history.history_file import HistoryEntry
from benchmark.gate.history.steps import LevelStep, level_steps
from reports import Figure, Panel
from reports.figures.style import INK, MUTED, SMALL, draw, heading
from reports.formatting import counted
from reports.palette import PALETTE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

MOST_CHECKS = 100
LEAST_CHECKS = 2
TIME, VALUE = "time, first check = 1", "value, first check = 1"
VALUE_SCATTER = 1e-5
"""Relative scatter of a value between machines: a step stands far above it."""
TIME_CAPTION = (
    "Time in units of its references, relative to the first check shown: a dot a check, with its "
    "95\N{NO-BREAK SPACE}% interval; a short bar is the limit of that check, a cross one that was called slower; a "
    "dashed line is a step, with the commit that was checked first on the new level."
)
VALUE_CAPTION = (
    "Gated values that moved, relative to the first check shown: a dot a check; a dashed line is a step, with the "
    "commit that was checked first on the new level."
)
HEADROOM = 0.15
COLOURS = {False: PALETTE["fem"].light, True: PALETTE["failed"].light}
MARKERS = {False: "o", True: "X"}


@dataclass(frozen=True)
class TrendPoint:
    """One check of one quantity: time or value relative to the first, its interval and limit (or None)."""

    number: int
    revision: str
    ratio: float
    ci95: tuple[float, float] | None
    allowed: float | None

    @property
    def failed(self) -> bool:
        """Whether it was called slower."""
        return self.allowed is not None and self.ratio > self.allowed


@dataclass(frozen=True)
class Trend:
    """A quantity over the checks, oldest first.

    Attributes
    ----------
    quantity
        Its name.
    points
        Its checks.
    steps
        Where its level changed, as places in `points`; levels are logarithms of ratios for times, ratios for values.
    label
        Of the ordinate.
    """

    quantity: str
    points: tuple[TrendPoint, ...]
    steps: tuple[LevelStep, ...]
    label: str

    def step_percent(self, step: LevelStep) -> float:
        """How far a step goes, in per cent of the level before it."""
        if self.label == TIME:
            return 100.0 * float(np.expm1(step.after - step.before))
        return 100.0 * (step.after / step.before - 1.0)


def trends(history: Sequence[HistoryEntry], machine: str, *, against: bool) -> list[Trend]:
    """Return the trends of the last check's quantities over the checks of one machine and way of comparing.

    A quantity that has fewer than two such checks has none.
    """
    alike = [each for each in history if each.machine == machine and (each.against is not None) == against][
        -MOST_CHECKS:
    ]
    names = list(alike[-1].timing) if alike else []
    found = [_time_trend(name, _points(name, alike)) for name in names]
    return [each for each in found if len(each.points) >= LEAST_CHECKS]


def value_trends(history: Sequence[HistoryEntry]) -> list[Trend]:
    """Return the trends of the last check's gated values, of all machines, since values do not depend on them."""
    recent = history[-MOST_CHECKS:]
    names = list(recent[-1].accuracy) if recent else []
    found = [_value_trend(name, recent) for name in names]
    return [each for each in found if each is not None]


def _time_trend(name: str, points: tuple[TrendPoint, ...]) -> Trend:
    return Trend(name, points, level_steps([np.log(each.ratio) for each in points], least=2), TIME)


def _value_trend(name: str, history: Sequence[HistoryEntry]) -> Trend | None:
    """None where the value was not there, or is zero, twice at least."""
    values = [(number, each, each.accuracy.get(name)) for number, each in enumerate(history, start=1)]
    present = [(number, each, value) for number, each, value in values if value is not None]
    if len(present) < LEAST_CHECKS or not present[0][2]:
        return None
    first = present[0][2]
    points = tuple(TrendPoint(number, _short(each), value / first, None, None) for number, each, value in present)
    return Trend(name, points, level_steps([each.ratio for each in points], least=1, scatter=VALUE_SCATTER), VALUE)


def _short(entry: HistoryEntry) -> str:
    """A check's commit as a person says it: seven letters, and a + for changes that were not committed."""
    if entry.revision is None:
        return "?"
    return entry.revision[:7] + ("+" if entry.revision.endswith("+") else "")


def trend_figure(found: Sequence[Trend], title: str = "Trend of the timed quantities") -> Figure:
    """Draw one panel a quantity: time or value relative to the first check, 95 % intervals, limits, steps.

    Parameters
    ----------
    found
        At least one, with at least two checks each; all times or all values.
    title
        Of the figure.
    """
    panels = [Panel(draw(_Painter(trend).paint, SMALL, 250), _words(trend), trend.quantity) for trend in found]
    caption = VALUE_CAPTION if found[0].label == VALUE else TIME_CAPTION
    return Figure(panels, caption, title)


def _points(name: str, history: Sequence[HistoryEntry]) -> tuple[TrendPoint, ...]:
    entries = [
        (number, _short(each), each.timing[name]) for number, each in enumerate(history, start=1) if name in each.timing
    ]
    if not entries:
        return ()
    first = entries[0][2]["ratio"]
    return tuple(
        TrendPoint(
            number,
            revision,
            each["ratio"] / first,
            None if each["ci95"] is None else (each["ci95"][0] / first, each["ci95"][1] / first),
            None if each["allowed"] is None else each["allowed"] / first,
        )
        for number, revision, each in entries
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
        axes.margins(y=HEADROOM)
        axes.set_xlabel("check", color=MUTED)
        axes.set_ylabel(self.trend.label, color=MUTED)
        for step in self.trend.steps:
            _mark(axes, self.trend.points[step.place])
        heading(axes, self.trend.quantity)


def _mark(axes: Axes, point: TrendPoint) -> None:
    """A step, by the commit that was checked first on the new level."""
    axes.axvline(point.number - 0.5, color=MUTED, linestyle="--", linewidth=1.0)
    axes.annotate(
        point.revision,
        (point.number - 0.5, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(3, -10),
        textcoords="offset points",
        color=MUTED,
        fontsize="small",
    )


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
        f"{trend.quantity} over {counted(len(ratios), 'check')}, relative to the first: {min(ratios):.3g} to "
        f"{max(ratios):.3g}, last {ratios[-1]:.3g}; {failed} called slower; {counted(len(trend.steps), 'step')}."
    )
