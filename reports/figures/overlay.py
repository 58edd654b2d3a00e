"""Several runs in one picture: a line a run, a panel a layer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, LiveAxes, LivePlot, Panel
from reports.figures.arrays import Floats, column
from reports.figures.live_lines import live_line
from reports.figures.style import SMALL, WIDE, LineStyle, draw, heading, zero_line
from reports.formatting import format_number, shortened
from reports.palette import PALETTE

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

Line = tuple[Any, Any]
"""Abscissa and ordinate, (n,) each; NaN where there is no value."""

LOOKS: Sequence[tuple[str, LineStyle]] = tuple(
    (PALETTE[name].light, dash)
    for dash in ("-", (0, (5, 2)), (0, (1.2, 1.6)))
    for name in ("fem", "wave", "incomplete", "good", "ink", "tissue")
)
"""Colour and dash of each line, in order; they repeat after eighteen."""


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
        _Panel(name, place if len(panels) > 1 else None, _checked(lines), looks, (x_label, y_label), downwards)
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
class _Panel:
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
            axes.plot(x, y, color=colour, linestyle=dash, label=shortened(name, 40))
        if self.downwards:
            axes.invert_yaxis()
        axes.set(xlabel=self.labels[0], ylabel=self.labels[1])
        heading(axes, self.name, self.place)
        drawing.legend(loc="outside lower left", ncols=1)

    def live(self) -> LivePlot:
        """The same lines, to zoom."""
        lines = [live_line(name, x, y, *self.looks[name]) for name, (x, y) in self.lines.items()]
        return LivePlot(self.labels[0], (LiveAxes(self.labels[1], lines, self.downwards),))

    def words(self) -> str:
        """Say what the panel shows."""
        parts = [f"{name} {_largest(y)}" for name, (_, y) in self.lines.items()]
        return f"{self.name}, {self.labels[1]}, largest value of each run: {'; '.join(parts)}."


def _largest(values: Floats) -> str:
    if not np.isfinite(values).any():
        return "without values"
    return format_number(float(values[int(np.nanargmax(np.abs(values)))]))
