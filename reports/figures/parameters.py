"""Results over each parameter of a study, a dot a point, a panel a parameter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, column
from reports.figures.pair import DEFAULT, Pair
from reports.figures.style import INK, MEASURED, SMALL, Stroke, draw, heading, legend_above
from reports.formatting import format_number, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

MOST_DOTS = 400


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
    series = [(_stroke(name, pair), column(name, values, size)) for name, values in results.items()]
    every = -(-size // MOST_DOTS)
    panels = [
        _Panel(axis, axis.positions(), series, quantity, place if len(axes) > 1 else None, every)
        for place, axis in enumerate(axes)
    ]
    pictures = [Panel(draw(panel.paint, SMALL, 300), panel.describe(), panel.axis.name) for panel in panels]
    text = f"{quantity[0].upper()}{quantity[1:]} over each varied parameter, a dot a point"
    text += f", every {every}th point drawn" if every > 1 else ""
    return Figure(pictures, text + ("." if len(axes) == 1 else "; the other parameters vary as well."), title)


@dataclass(frozen=True)
class _Panel:
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


def _stroke(name: str, pair: Pair) -> Stroke:
    return {"fem": pair.fem, "wave": pair.wave}.get(name, replace(MEASURED, label=name, name=name, colour=INK))


def _span(values: Floats) -> str:
    """The smallest to the largest number, in words."""
    if not np.isfinite(values).any():
        return "without values"
    return f"from {format_number(float(np.nanmin(values)))} to {format_number(float(np.nanmax(values)))}"
