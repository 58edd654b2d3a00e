"""Fitted parameters as dots with their 95 % intervals, an axis for each unit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from reports.blocks import Figure
from reports.figures.style import FEM, INK, MUTED, PAPER, WIDE, draw
from reports.formatting import format_number, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


@dataclass(frozen=True)
class FittedParameter:
    """A fitted value in `unit` with the ends of its 95 % interval, None where the fit gives no interval."""

    name: str
    value: float
    unit: str = ""
    low: float | None = None
    high: float | None = None
    identifiable: bool = True

    @property
    def interval(self) -> tuple[float, float] | None:
        """Both ends of the interval, None unless both are finite."""
        ends = (np.nan if self.low is None else self.low, np.nan if self.high is None else self.high)
        return (float(ends[0]), float(ends[1])) if np.isfinite(ends).all() else None

    def text(self) -> str:
        """Return value, interval and unit as words."""
        parts = [format_number(float(self.value), 3)]
        if self.interval is not None:
            parts.append(f"[{', '.join(format_number(end, 3) for end in self.interval)}]")
        return " ".join([*parts, *([self.unit] if self.unit else [])])


def fitted_parameters(parameters: Sequence[FittedParameter]) -> Figure:
    """Draw each parameter's value and 95 % interval, those of one unit on one axis.

    The axis is logarithmic where all values of the unit are positive and they span more than a factor of 30.
    A parameter the data does not identify has a hollow dot and says so.

    Raises
    ------
    ValueError
        Without a parameter.
    """
    if not parameters:
        raise ValueError("parameters is empty; at least one fitted parameter is needed")
    groups: dict[str, list[FittedParameter]] = {}
    for parameter in parameters:
        groups.setdefault(parameter.unit, []).append(parameter)

    def paint(drawing: Drawing) -> None:
        ratios = [len(group) + 1.1 for group in groups.values()]
        axes = drawing.subplots(len(groups), 1, squeeze=False, height_ratios=ratios)[:, 0]
        for part, (unit, group) in zip(axes, groups.items(), strict=True):
            _paint_group(part, unit, group)

    words = "; ".join(f"{parameter.name} {parameter.text()}" for parameter in parameters) + "."
    caption = "Fitted values (dots) with their 95\N{NO-BREAK SPACE}% intervals (bars)."
    if not all(parameter.identifiable for parameter in parameters):
        caption += " Hollow dots: the data does not identify this parameter."
    height = 16 + 40 * len(parameters) + 60 * len(groups)
    return Figure.of(draw(paint, WIDE, height), caption, words, "Fitted parameters")


def _paint_group(axes: Axes, unit: str, group: Sequence[FittedParameter]) -> None:
    for row, parameter in enumerate(group):
        _paint_parameter(axes, row, parameter)
    _scale(axes, group)
    axes.set_yticks(range(len(group)), [shortened(parameter.name, 26) for parameter in group], color=INK)
    axes.set_ylim(len(group) - 0.4, -0.6)
    axes.set_xlabel(f"value ({unit})" if unit else "value (without unit)", color=MUTED)
    axes.grid(visible=False, axis="y")
    if axes.get_xscale() == "linear":
        axes.locator_params(axis="x", nbins=3)


def _paint_parameter(axes: Axes, row: int, parameter: FittedParameter) -> None:
    colour = FEM.colour if parameter.identifiable else MUTED
    if parameter.interval is not None:
        axes.plot(parameter.interval, (row, row), color=colour, linewidth=2.2, alpha=0.6)
    dot = colour if parameter.identifiable else PAPER
    axes.plot(parameter.value, row, marker="o", markersize=8, markeredgewidth=1.6, color=colour, markerfacecolor=dot)
    note = "" if parameter.identifiable else "\nnot identifiable"
    axes.annotate(parameter.text() + note, (1.03, row), xycoords=("axes fraction", "data"), va="center", color=INK)


def _scale(axes: Axes, group: Sequence[FittedParameter]) -> None:
    """Choose the scale of an axis, with some room at its ends."""
    ends = [end for item in group for end in (item.value, *(item.interval or ()))]
    numbers = np.array([end for end in ends if np.isfinite(end)])
    if not numbers.size:
        return
    low, high = float(numbers.min()), float(numbers.max())
    if low > 0 and high > 30 * low:
        axes.set_xscale("log")
        axes.set_xlim(low / 2, high * 2)
        return
    room = 0.12 * (high - low) or 0.1 * abs(high) or 1.0
    axes.set_xlim(low - room, high + room)
