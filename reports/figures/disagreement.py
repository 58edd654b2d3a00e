"""Where measurement and model disagree, as a map, and single channels beside the model before and after its repair.

The map has a row a channel and a column a phase, depth upwards in each field. A channel shows the noise as a band.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, column, thinned
from reports.figures.style import (
    FEM,
    GRID,
    INK,
    MEASURED,
    SMALL,
    TRIAL,
    WAVE,
    WIDE,
    Stroke,
    draw,
    heading,
    legend_above,
    zero_line,
)
from reports.formatting import format_number, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


_FIELD = 0.92
_STRONGEST = 0.75
BEFORE = Stroke("Before", WAVE.colour, WAVE.line, "s", "the model before")
AFTER = Stroke("After", FEM.colour, "-", "o", "the model after")
_BAND = 2.0


@dataclass(frozen=True)
class Disagreement:
    """A cell: its row and column by name, which cycle, the range of depth in mm, and the mean residual.

    Attributes
    ----------
    row, column
        Names: a channel, and a phase.
    cycle
        From 1; 0 where it is no part of a cycle.
    depth_mm
        Low and high.
    percent
        Mean of measured minus model in % of the channel's largest signal, signed.
    text
        The residual with its unit.
    p
        Family-wise.
    """

    row: str
    column: str
    cycle: int
    depth_mm: tuple[float, float]
    percent: float
    text: str
    p: float


def where_map(cells: Sequence[Disagreement], rows: Sequence[str], columns: Sequence[str]) -> Figure:
    """Draw the cells that are significant; fields without any stay empty.

    Parameters
    ----------
    cells
        At least one, each with its row and column among `rows` and `columns`.
    rows, columns
        All that were looked at, in order.

    Raises
    ------
    ValueError
        Without a cell, or for a cell in a row or column that is not there.
    """
    if not cells:
        raise ValueError("cells is empty; at least one is needed")
    lost = [cell for cell in cells if cell.row not in rows or cell.column not in columns]
    if lost:
        raise ValueError(f"the cell {lost[0].row}, {lost[0].column} is in no row and column of the map")
    chart = _Map(cells, rows, columns)
    height = 74 + 96 * len(rows)
    caption = (
        "Where measurement and model disagree: orange where more was measured than simulated, blue where less, the "
        "stronger the larger; in each field the depth goes upwards from zero to the deepest and cycles to the right. "
        "Empty fields: nothing significant. Numbers: mean residual in % of the channel's largest signal."
    )
    return Figure.of(draw(chart.paint, WIDE, height), caption, chart.words(), "Where")


@dataclass(frozen=True)
class _Map:
    cells: Sequence[Disagreement]
    rows: Sequence[str]
    columns: Sequence[str]

    def paint(self, drawing: Drawing) -> None:
        axes = drawing.subplots()
        axes.set(xlim=(-0.5, len(self.columns) - 0.5), ylim=(len(self.rows) - 0.5, -0.5))
        axes.grid(visible=False)
        axes.spines[:].set_visible(False)
        axes.tick_params(length=0)
        axes.set_xticks(range(len(self.columns)), [_two_lines(name) for name in self.columns], color=INK)
        axes.set_yticks(range(len(self.rows)), [shortened(name, 26) for name in self.rows], color=INK)
        for row in range(len(self.rows)):
            for place in range(len(self.columns)):
                self._frame(axes, row, place)
        for cell in self.cells:
            self._cell(axes, cell)

    def _frame(self, axes: Axes, row: int, column: int) -> None:
        from matplotlib.patches import Rectangle

        corner = (column - 0.5 * _FIELD, row - 0.5 * _FIELD)
        axes.add_patch(Rectangle(corner, _FIELD, _FIELD, facecolor="none", edgecolor=GRID, linewidth=1))

    def _cell(self, axes: Axes, cell: Disagreement) -> None:
        from matplotlib.patches import Rectangle

        left, width, top, height = self._place(cell)
        colour = WAVE.colour if cell.percent > 0 else FEM.colour
        strength = 0.15 + (_STRONGEST - 0.15) * min(abs(cell.percent) / self._largest, 1.0)
        axes.add_patch(Rectangle((left, top), width, height, facecolor=colour, alpha=strength, linewidth=0))
        if width > 0.4 * _FIELD and height > 0.17:
            axes.text(
                left + 0.5 * width, top + 0.5 * height, f"{cell.percent:+.2g}".replace("-", "−"),
                ha="center", va="center", fontsize="small", color=INK,
            )  # fmt: skip

    def _place(self, cell: Disagreement) -> tuple[float, float, float, float]:
        """Left, width, top and height of a cell in its field."""
        cycles = self._cycles(cell)
        width = _FIELD / len(cycles)
        left = self.columns.index(cell.column) - 0.5 * _FIELD + cycles.index(cell.cycle) * width
        sharing = self._sharing(cell)
        width /= len(sharing)
        left += width * next(place for place, each in enumerate(sharing) if each is cell)
        deepest = max(max(each.depth_mm) for each in self.cells) or 1.0
        low, high = (min(max(end, 0.0), deepest) / deepest for end in cell.depth_mm)
        height = max(_FIELD * (high - low), 0.1)
        bottom = self.rows.index(cell.row) + 0.5 * _FIELD - _FIELD * low
        top = max(bottom - height, self.rows.index(cell.row) - 0.5 * _FIELD)
        return left, width, top, height

    def _sharing(self, cell: Disagreement) -> list[Disagreement]:
        """The cells at the same depths of the same field and cycle, which stand side by side."""
        key = (cell.row, cell.column, cell.cycle)
        low, high = cell.depth_mm
        return [
            each
            for each in self.cells
            if (each.row, each.column, each.cycle) == key
            and (each is cell or (each.depth_mm[0] < high and low < each.depth_mm[1]))
        ]

    def _cycles(self, cell: Disagreement) -> list[int]:
        return sorted({each.cycle for each in self.cells if each.column == cell.column})

    @property
    def _largest(self) -> float:
        return max(abs(cell.percent) for cell in self.cells) or 1.0

    def words(self) -> str:
        """Say what the map shows."""
        told = "; ".join(
            f"{cell.row} in {cell.column}{f' of cycle {cell.cycle}' if cell.cycle else ''}, "
            f"{_read(cell.depth_mm[0])} to {_read(cell.depth_mm[1])} mm: {cell.text} (p = {_read(cell.p)})"
            for cell in self.cells[:6]
        )
        more = len(self.cells) - 6
        return f"{told}{f'; and {more} more' if more > 0 else ''}."


def _two_lines(name: str) -> str:
    first, _, rest = name.partition(" ")
    return f"{first}\n{rest}" if rest else name


def _read(value: float) -> str:
    return format_number(float(value), 2)


@dataclass(frozen=True)
class RepairedTrace:
    """One channel of one trial.

    Attributes
    ----------
    title
        What the panel is called.
    x
        Shape (n,), ascending or not: time in s, or whatever `x_label` says.
    measured, before, after
        Shape (n,) in `unit`, NaN where nothing was measured.
    noise
        Shape (n,): standard deviation of the replicates round their mean; zeros leave the band out.
    channel, unit
        Name of the channel and the unit of its values.
    x_label
        What `x` is, with its unit.
    """

    title: str
    x: Any
    measured: Any
    before: Any
    after: Any
    noise: Any
    channel: str
    unit: str
    x_label: str = "time (s)"
    arrays: tuple[Floats, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        x = column(f"{self.title}: x", self.x)
        rest = [
            column(f"{self.title}: {name}", getattr(self, name), x.size)
            for name in ("measured", "before", "after", "noise")
        ]
        object.__setattr__(self, "arrays", (x, *rest))


def repaired(
    traces: Sequence[RepairedTrace], changed: bool = True, measured: str = MEASURED.label, width: float = WIDE
) -> Figure:
    """Draw each trace in a panel: above the values, below measured minus model.

    Parameters
    ----------
    traces
        At least one.
    changed
        Whether the model was repaired; otherwise only `before` is drawn, as the model.
    measured
        What the measured line is called.
    width
        Natural width of a single panel, px; several are small.

    Raises
    ------
    ValueError
        Without a trace, or for arrays of other shapes.
    """
    if not traces:
        raise ValueError("traces is empty; at least one trace is needed")
    several = len(traces) > 1
    panels = [
        Panel(
            draw(
                _Panel(trace, place if several else None, changed, measured).paint,
                *((SMALL, 370) if several else (width, 0.72 * width)),
            ),
            _words(trace, changed),
            trace.title,
        )
        for place, trace in enumerate(traces)
    ]
    banded = any(trace.arrays[4].any() for trace in traces)
    caption = f"{measured} values and the model"
    caption += " before (dashed) and after (solid) the effect was added" if changed else ""
    caption += f"; below, {measured if measured.isupper() else measured.lower()} minus model"
    caption += ", with the spread of the replicates (two standard deviations) as a band." if banded else "."
    return Figure(panels, caption, "Measured against simulated")


@dataclass(frozen=True)
class _Panel:
    trace: RepairedTrace
    place: int | None
    changed: bool
    measured: str

    def paint(self, drawing: Drawing) -> None:
        x, measured, before, after, noise = self.trace.arrays
        top, bottom = drawing.subplots(2, 1, sharex=True, height_ratios=(1.8, 1))
        top.plot(*thinned(x, measured), color=MEASURED.colour, linewidth=2.6, label=self.measured)
        zero_line(bottom)
        if noise.any():
            _band(bottom, x, noise)
        lines = [(before, BEFORE), (after, AFTER)] if self.changed else [(before, BEFORE)]
        for values, stroke in lines:
            label = stroke.label if self.changed else "Model"
            top.plot(*thinned(x, values), color=stroke.colour, linestyle=stroke.line, linewidth=1.6, label=label)
            bottom.plot(*thinned(x, measured - values), color=stroke.colour, linestyle=stroke.line, linewidth=1.3)
        top.set_ylabel(f"{self.trace.channel} ({self.trace.unit})")
        bottom.set_ylabel(f"residual ({self.trace.unit})")
        bottom.set_xlabel(self.trace.x_label)
        heading(top, self.trace.title, self.place, room=24)
        legend_above(top, 3)


def _band(axes: Axes, x: Floats, noise: Floats) -> None:
    order = np.argsort(x, kind="stable")
    wide = _BAND * noise[order]
    axes.fill_between(x[order], -wide, wide, color=TRIAL.colour, alpha=0.25, linewidth=0)


def _words(trace: RepairedTrace, changed: bool) -> str:
    _, measured, before, after, _ = trace.arrays
    text = f"{trace.title}: {trace.channel}, root mean square of measured minus model "
    text += f"{_rms(measured - before)} {trace.unit}"
    return text + (f" before and {_rms(measured - after)} {trace.unit} after." if changed else ".")


def _rms(values: Floats) -> str:
    present = values[np.isfinite(values)]
    return format_number(float(np.sqrt(np.mean(present**2))) if present.size else float("nan"), 3)
