"""Several runs in one picture: a line a run and a panel a layer, or results over each parameter of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, LiveAxes, LivePlot, Panel
from reports.figures.arrays import Floats, column
from reports.figures.style import (
    DEFAULT,
    INK,
    MEASURED,
    SMALL,
    WIDE,
    LineStyle,
    Pair,
    Stroke,
    draw,
    heading,
    legend_above,
    live_line,
    zero_line,
)
from reports.formatting import format_number, shortened
from reports.palette import PALETTE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


Line = tuple[Any, Any]
"""Abscissa and ordinate, (n,) each; NaN where there is no value."""

LOOKS: Sequence[tuple[str, LineStyle]] = tuple(
    (PALETTE[name].light, dash)
    for dash in ("-", (0, (5, 2)), (0, (1.2, 1.6)))
    for name in ("fem", "wave", "incomplete", "good", "ink", "tissue")
)
"""Colour and dash of each line, in order; they repeat after eighteen."""
WIDTHS = (8.0, 3.4, 5.6, 1.6)
"""Widths of the lines in order, the narrow ones on top: a line that another covers shows on both sides of it."""
MOST_DOTS = 400


def overlay(
    panels: Mapping[str, Mapping[str, Line]],
    x_label: str,
    y_label: str,
    caption: str,
    title: str,
    downwards: bool = False,
) -> Figure:
    """Draw lines of several runs over each other.

    Parameters
    ----------
    panels
        Name of the panel (a layer) to its lines by the run's name; a run keeps its look in all panels.
    x_label, y_label
        What the axes are, with units.
    caption, title
        Of the figure.
    downwards
        Whether the ordinate points down, as a dent does.

    Raises
    ------
    ValueError
        Without a panel or a line, or for a line whose arrays differ in length.
    """
    names = list(dict.fromkeys(name for lines in panels.values() for name in lines))
    if not names:
        raise ValueError("panels is empty; at least one panel with one line is needed")
    looks = {name: LOOKS[place % len(LOOKS)] for place, name in enumerate(names)}
    drawn = [
        _RunPanel(name, place if len(panels) > 1 else None, _checked(lines), looks, (x_label, y_label), downwards)
        for place, (name, lines) in enumerate(panels.items())
    ]
    width, height = (SMALL, 290) if len(drawn) > 1 else (WIDE, 350)
    height += 21 * len(names)
    pictures = [Panel(draw(each.paint, width, height), each.words(), each.name, each.live()) for each in drawn]
    return Figure(pictures, caption, title)


def _checked(lines: Mapping[str, Line]) -> dict[str, tuple[Floats, Floats]]:
    found = {}
    for name, (x, y) in lines.items():
        across = column(f"abscissa of {name}", x)
        found[name] = across, column(f"ordinate of {name}", y, len(across))
    return found


@dataclass(frozen=True)
class _RunPanel:
    """One picture."""

    name: str
    place: int | None
    lines: Mapping[str, tuple[Floats, Floats]]
    looks: Mapping[str, tuple[str, LineStyle]]
    labels: tuple[str, str]
    downwards: bool

    def paint(self, drawing: Drawing) -> None:
        """Draw the lines, with a legend of one column under the axes."""
        axes = drawing.subplots()
        zero_line(axes)
        for name, (x, y) in self.lines.items():
            colour, dash = self.looks[name]
            width = self._width(name)
            (line,) = axes.plot(x, y, color=colour, linestyle=dash, label=shortened(name, 40))
            line.set(linewidth=width, zorder=3.0 - 0.1 * width)
        if self.downwards:
            axes.invert_yaxis()
        axes.set(xlabel=self.labels[0], ylabel=self.labels[1])
        heading(axes, self.name, self.place)
        drawing.legend(loc="outside lower left", ncols=1)

    def _width(self, name: str) -> float:
        return WIDTHS[list(self.looks).index(name) % len(WIDTHS)]

    def live(self) -> LivePlot:
        """The same lines, to zoom."""
        lines = [live_line(name, x, y, *self.looks[name], self._width(name)) for name, (x, y) in self.lines.items()]
        return LivePlot(self.labels[0], (LiveAxes(self.labels[1], lines, self.downwards),))

    def words(self) -> str:
        """Say what the panel shows."""
        parts = [f"{name} {_largest(y)}" for name, (_, y) in self.lines.items()]
        return f"{self.name}, {self.labels[1]}, largest value of each run: {'; '.join(parts)}."


def _largest(values: Floats) -> str:
    if not np.isfinite(values).any():
        return "without values"
    return format_number(float(values[int(np.nanargmax(np.abs(values)))]))


@dataclass(frozen=True)
class ParameterAxis:
    """A varied parameter: its name, its unit, its value at each of n points (numbers or words), its scale."""

    name: str
    values: Sequence[float] | Sequence[str]
    unit: str = ""
    logarithmic: bool = False

    @property
    def words(self) -> list[str]:
        """The different words, in order of appearance; empty for numbers."""
        return list(dict.fromkeys(value for value in self.values if isinstance(value, str)))

    def positions(self) -> Floats:
        """Where the points lie on the axis, (n,); words stand at 0, 1, 2..."""
        places = {word: place for place, word in enumerate(self.words)}
        return column(self.name, [places[value] if isinstance(value, str) else value for value in self.values])


def over_parameters(
    axes: Sequence[ParameterAxis],
    results: Mapping[str, Any],
    quantity: str,
    title: str,
    pair: Pair = DEFAULT,
) -> Figure:
    """Draw results over each parameter; with a single one, dots are joined by a line.

    Parameters
    ----------
    axes
        The parameters, at least one, with n points each.
    results
        Name of each series (`fem` and `wave` get their looks) to its values, shape (n,), NaN where there is none.
    quantity
        What the values are, with their unit.
    title
        The figure's.
    pair
        What `fem` and `wave` are called.

    Raises
    ------
    ValueError
        Without a parameter or a series, or for series of other lengths.
    """
    if not axes or not results:
        raise ValueError("axes or results is empty; at least one parameter and one series are needed")
    size = len(axes[0].values)
    series = [
        (pair.stroke(name, replace(MEASURED, colour=INK)), column(name, values, size))
        for name, values in results.items()
    ]
    every = -(-size // MOST_DOTS)
    panels = [
        _ParameterPanel(axis, axis.positions(), series, quantity, place if len(axes) > 1 else None, every)
        for place, axis in enumerate(axes)
    ]
    pictures = [Panel(draw(panel.paint, SMALL, 300), panel.describe(), panel.axis.name) for panel in panels]
    text = f"{quantity[0].upper()}{quantity[1:]} over each varied parameter, a dot a point"
    text += f", every {every}th point drawn" if every > 1 else ""
    return Figure(pictures, text + ("." if len(axes) == 1 else "; the other parameters vary as well."), title)


@dataclass(frozen=True)
class _ParameterPanel:
    """One picture."""

    axis: ParameterAxis
    positions: Floats
    series: Sequence[tuple[Stroke, Floats]]
    quantity: str
    place: int | None
    every: int

    def paint(self, drawing: Drawing) -> None:
        """Draw the dots."""
        axes = drawing.subplots()
        order = np.argsort(self.positions, kind="stable")[:: self.every]
        joined = self.place is None and not self.axis.words
        for stroke, values in self.series:
            axes.plot(
                self.positions[order],
                values[order],
                color=stroke.colour,
                marker=stroke.marker,
                markersize=4,
                markerfacecolor="none" if stroke.line != "-" else stroke.colour,
                linestyle=stroke.line if joined else "",
                label=stroke.label,
            )
        self._scale(axes)
        axes.set_ylabel(self.quantity)
        heading(axes, self.axis.name, self.place, room=24)
        if len(self.series) > 1:
            legend_above(axes)

    def _scale(self, axes: Axes) -> None:
        words = self.axis.words
        if words:
            axes.set_xticks(range(len(words)), [shortened(word, 16) for word in words])
            axes.set_xlim(-0.5, len(words) - 0.5)
        elif self.axis.logarithmic:
            axes.set_xscale("log")
            low, high = np.log10([self.positions.min(), self.positions.max()])
            ticks = [float(f"{10**power:.2g}") for power in np.linspace(low, high, 4)]
            axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
            axes.set_xticks([], minor=True)
        unit = f" ({self.axis.unit})" if self.axis.unit else ""
        axes.set_xlabel(f"{shortened(self.axis.name, 36)}{unit}")

    def describe(self) -> str:
        """Say what the picture shows."""
        words, unit = self.axis.words, f" {self.axis.unit}" if self.axis.unit else ""
        span = ", ".join(words) if words else f"{_span(self.positions)}{unit}"
        parts = [f"{stroke.name} {_span(values)}" for stroke, values in self.series]
        return f"{self.quantity} over {self.axis.name} ({span}): {'; '.join(parts)}."


def _span(values: Floats) -> str:
    """The smallest to the largest number, in words."""
    if not np.isfinite(values).any():
        return "without values"
    return f"from {format_number(float(np.nanmin(values)))} to {format_number(float(np.nanmax(values)))}"
