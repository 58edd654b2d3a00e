"""A row for each name: fitted parameters with intervals, ranked candidates, gaps before and after, shares with bars."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from reports.blocks import Figure
from reports.figures.disagreement import AFTER, BEFORE
from reports.figures.style import FEM, INK, MUTED, PAPER, WIDE, draw, legend_above
from reports.formatting import format_number, shortened
from reports.palette import PALETTE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_TWO_SIDED = 1.96
GOOD, FAILED = PALETTE["good"].light, PALETTE["failed"].light


@dataclass(frozen=True)
class ParameterRow:
    """A fitted value in `unit` with the ends of its 95 % interval, None where the fit gives no interval."""

    name: str
    value: float
    unit: str = ""
    low: float | None = None
    high: float | None = None
    identifiable: bool = True

    @property
    def interval(self) -> tuple[float, float] | None:
        """Both ends of the interval, None unless both are finite and the data identify the value."""
        if not self.identifiable:
            return None
        ends = (np.nan if self.low is None else self.low, np.nan if self.high is None else self.high)
        return (float(ends[0]), float(ends[1])) if np.isfinite(ends).all() else None

    def text(self) -> str:
        """Return value, interval and unit as words."""
        parts = [format_number(float(self.value), 3)]
        if self.interval is not None:
            parts.append(f"[{', '.join(format_number(end, 3) for end in self.interval)}]")
        return " ".join([*parts, *([self.unit] if self.unit else [])])


def fitted_parameters(parameters: Sequence[ParameterRow]) -> Figure:
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
    groups: dict[str, list[ParameterRow]] = {}
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


def _paint_group(axes: Axes, unit: str, group: Sequence[ParameterRow]) -> None:
    for row, parameter in enumerate(group):
        _paint_parameter(axes, row, parameter)
    _scale(axes, group)
    _name_rows(axes, [parameter.name for parameter in group], 26)
    axes.set_xlabel(f"value ({unit})" if unit else "value (without unit)", color=MUTED)
    if axes.get_xscale() == "linear":
        axes.locator_params(axis="x", nbins=3)


def _paint_parameter(axes: Axes, row: int, parameter: ParameterRow) -> None:
    colour = FEM.colour if parameter.identifiable else MUTED
    if parameter.interval is not None:
        _interval(axes, row, parameter.interval, colour)
    _dot(axes, row, parameter.value, colour, colour if parameter.identifiable else PAPER)
    _note(axes, row, parameter.text() + ("" if parameter.identifiable else "\nnot identifiable"))


def _scale(axes: Axes, group: Sequence[ParameterRow]) -> None:
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
            _paint_candidate(axes, row, candidate, gains)
        _name_rows(axes, [each.name for each in candidates], 27)
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


def _paint_candidate(axes: Axes, row: int, candidate: RankedCandidate, gains: bool) -> None:
    colour = FEM.colour if candidate.chosen else MUTED
    value = candidate.gain if gains else 100 * (math.nan if candidate.gap_closed is None else candidate.gap_closed)
    if gains and math.isfinite(candidate.standard_error):
        reach = _TWO_SIDED * candidate.standard_error
        _interval(axes, row, (value - reach, value + reach), colour)
    if math.isfinite(value):
        _dot(axes, row, value, colour, colour if candidate.chosen else "none")
    _note(axes, row, candidate.text(), "small")


@dataclass(frozen=True)
class GapRow:
    """Root mean squares in `unit`; the floor is None where there are no replicates."""

    name: str
    before: float
    after: float
    floor: float | None
    unit: str

    def text(self) -> str:
        """Before and after in words."""
        return f"{format_number(self.before, 3)} → {format_number(self.after, 3)} {self.unit}"


def gap_bars(gaps: Sequence[GapRow], held_out: str) -> Figure:
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
            _paint_gap(axes, row, gap)
        _name_rows(axes, [gap.name for gap in gaps], 24)
        axes.set_xlim(0, max(105.0, *(108 * gap.after / gap.before for gap in gaps)))
        axes.set_xlabel("root mean square of measured minus model (% of before)")
        legend_above(axes, 3)

    floors = any(gap.floor is not None for gap in gaps)
    caption = f"What is left between measurement and model, before and after, on {held_out}"
    caption += "; the line is the floor: the spread of the replicates alone." if floors else "."
    words = "; ".join(f"{gap.name}: {gap.text()}{_floor(gap)}" for gap in gaps) + "."
    return Figure.of(draw(paint, WIDE, 100 + 52 * len(gaps)), caption, words, "The gap")


def _paint_gap(axes: Axes, row: int, gap: GapRow) -> None:
    label = row == 0
    for value, stroke, offset in ((gap.before, BEFORE, -0.17), (gap.after, AFTER, 0.17)):
        axes.barh(
            row + offset, 100 * value / gap.before, height=0.3, color=stroke.colour, alpha=0.75, linewidth=0,
            label=stroke.label if label else None,
        )  # fmt: skip
    if gap.floor is not None:
        x = 100 * gap.floor / gap.before
        axes.plot((x, x), (row - 0.4, row + 0.4), color=INK, linewidth=1.8, label="Floor" if label else None)
    _note(axes, row, gap.text(), "small")


def _floor(gap: GapRow) -> str:
    return "" if gap.floor is None else f", floor {format_number(gap.floor, 3)} {gap.unit}"


@dataclass(frozen=True)
class ShareRow:
    """A share of `n` cases with its 95 % interval, 0 to 1; its bar, where there is one, and whether it is reached."""

    name: str
    value: float
    low: float
    high: float
    n: int
    bar: float | None = None
    reached: bool | None = None

    def text(self) -> str:
        """The share in words."""
        return f"{round(100 * self.value):d} % of {self.n}"


def shares(rows: Sequence[ShareRow], caption: str, title: str) -> Figure:
    """Draw each share with its interval, and the bar that it should reach as a line.

    Raises
    ------
    ValueError
        Without a share.
    """
    if not rows:
        raise ValueError("rows is empty; at least one share is needed")

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots()
        for place, row in enumerate(rows):
            colour = FEM.colour if row.reached is None else GOOD if row.reached else FAILED
            _interval(axes, place, (100 * row.low, 100 * row.high), colour)
            _dot(axes, place, 100 * row.value, colour, PAPER if row.reached is False else colour)
            if row.bar is not None:
                axes.plot((100 * row.bar,) * 2, (place - 0.35, place + 0.35), color=INK, linewidth=1.8)
            _note(axes, place, row.text(), "small")
        _name_rows(axes, [row.name for row in rows], 36)
        axes.set_xlim(-3, 103)
        axes.set_xlabel("cases (%)")

    words = "; ".join(f"{row.name}: {row.text()}" for row in rows) + "."
    return Figure.of(draw(paint, WIDE, 70 + 27 * len(rows)), caption, words, title)


def _name_rows(axes: Axes, names: Sequence[str], length: int) -> None:
    """Put names beside the rows, the first at the top, cut to `length` characters."""
    axes.set_yticks(range(len(names)), [shortened(name, length) for name in names], color=INK)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.grid(visible=False, axis="y")


def _dot(axes: Axes, row: int, value: float, colour: str, face: str) -> None:
    axes.plot(value, row, marker="o", markersize=8, markeredgewidth=1.6, color=colour, markerfacecolor=face)


def _interval(axes: Axes, row: int, ends: tuple[float, float], colour: str) -> None:
    axes.plot(ends, (row, row), color=colour, linewidth=2.2, alpha=0.6)


def _note(axes: Axes, row: int, text: str, size: str | None = None) -> None:
    """Write the values of a row to its right."""
    axes.annotate(text, (1.03, row), xycoords=("axes fraction", "data"), va="center", color=INK, fontsize=size)
