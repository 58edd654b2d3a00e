"""Compute time: wall time of each model's repeats, and how it grows with unknowns."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure
from reports.figures.arrays import Floats, column
from reports.figures.style import DEFAULT, INK, MEASURED, MUTED, TRIAL, WIDE, Pair, Stroke, draw, legend_above
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


def timing(
    wall_s: Mapping[str, Any],
    setup_s: Mapping[str, float] | None = None,
    quoted_s: Mapping[str, float] | None = None,
    pair: Pair = DEFAULT,
) -> Figure:
    """Draw the wall seconds of every repeat as a dot and the median as a bar, a row a model.

    Parameters
    ----------
    wall_s
        Name of the model (`fem` and `wave` get their colours) to the wall seconds of its repeats, shape (n,).
    setup_s
        One-time set-up in s by model, drawn as a hollow diamond.
    quoted_s
        Times printed elsewhere in s by label, each a row of its own, drawn as a cross.
    pair
        What `fem` and `wave` are called.

    Raises
    ------
    ValueError
        For no model, no repeat, or a time that is not above zero.
    """
    walls = {name: _times(name, values) for name, values in wall_s.items()}
    if not walls:
        raise ValueError("wall_s is empty; the wall seconds of at least one model are needed")
    setups = {name: float(_times(f"set-up of {name}", [value])[0]) for name, value in (setup_s or {}).items()}
    quotes = {label: float(_times(label, [value])[0]) for label, value in (quoted_s or {}).items()}
    labels = [*(pair.stroke(name, TRIAL).label for name in walls), *quotes]

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots()
        _seconds_axis(axes, np.concatenate([*walls.values(), [*setups.values()], [*quotes.values()]]))
        for row, (name, values) in enumerate(walls.items()):
            _paint_row(axes, row, values, pair.stroke(name, TRIAL), setups.get(name))
        for row, value in enumerate(quotes.values(), len(walls)):
            axes.plot(value, row, marker="x", color=INK, markersize=7, markeredgewidth=1.6, linestyle="")
            _write(axes, value, row, f"{format_number(value, 3, trim=True)} s as printed")
        axes.set_yticks(range(len(labels)), labels, color=INK)
        axes.set_ylim(len(labels) - 0.45, -0.7)
        axes.grid(visible=False, axis="y")

    caption = "Wall seconds of the load history, a dot a repeat, the median as a bar with its value"
    caption += "; one-time set-up as a hollow diamond." if setups else "."
    caption += " Crosses are times printed elsewhere, measured on other machines." if quotes else ""
    return Figure.of(draw(paint, WIDE, 70 + 58 * len(labels)), caption, _words(walls, pair), "Wall time")


def _paint_row(axes: Axes, row: int, values: Floats, stroke: Stroke, setup: float | None) -> None:
    median = float(np.median(values))
    rows = np.full(values.shape, row)
    axes.plot(values, rows, "o", color=stroke.colour, alpha=0.55, markersize=7, markeredgewidth=0)
    axes.plot([median, median], [row - 0.26, row + 0.26], color=stroke.colour, linewidth=2.4)
    _write(axes, median, row, f"{format_number(median, 3)} s")
    if setup is not None:
        axes.plot(setup, row, marker="D", markerfacecolor="none", color=stroke.colour, markersize=6.5, linestyle="")


def _write(axes: Axes, x: float, row: int, text: str) -> None:
    """Write a value above its mark."""
    axes.annotate(text, (x, row), xytext=(0, 19), textcoords="offset points", ha="center", color=INK)


def _seconds_axis(axes: Axes, seconds: Floats) -> None:
    """Set a logarithmic axis over whole decades with plain numbers, with some room around the values."""
    low = np.floor(np.log10(seconds.min()) - 0.15)
    high = np.ceil(np.log10(seconds.max()) + 0.15)
    decades = 10.0 ** np.arange(low, high + 1)
    axes.set_xscale("log")
    axes.set_xticks(decades, [f"{value:.10g}" for value in decades])
    axes.set_xticks([], minor=True)
    axes.set_xlim(decades[0], decades[-1])
    axes.set_xlabel("wall time (s), logarithmic", color=MUTED)


def _times(name: str, values: Any) -> Floats:
    times = column(f"wall time of {name}", values)
    if not times.size or not (times > 0).all():
        raise ValueError(f"wall time of {name} is {times.tolist()} s; allowed: at least one value, all above 0 s")
    return times


def _words(walls: Mapping[str, Floats], pair: Pair) -> str:
    """Say what the figure shows."""
    return " ".join(
        f"{pair.stroke(name, TRIAL).label}: median {_read(np.median(values))} s of {values.size} repeats, "
        f"from {_read(values.min())} to {_read(values.max())} s."
        for name, values in walls.items()
    )


def _read(value: Any) -> str:
    return format_number(float(value), 3)


def growth(runs: Mapping[str, tuple[Any, Any]], pair: Pair = DEFAULT) -> Figure:
    """Draw wall time per load step over unknowns.

    Parameters
    ----------
    runs
        Model (`fem` and `wave` get their looks) to its unknowns and its wall ms per load step, (n,) each, all above 0.
    pair
        What `fem` and `wave` are called.

    Raises
    ------
    ValueError
        Without a run, for arrays of other lengths, or a value that is not above zero.
    """
    if not runs:
        raise ValueError("runs is empty; at least one model is needed")
    lines = [(pair.stroke(name, MEASURED), *_checked(name, *values)) for name, values in runs.items()]

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots()
        for stroke, unknowns, wall in lines:
            order = unknowns.argsort(kind="stable")
            axes.plot(
                unknowns[order], wall[order], color=stroke.colour, linestyle=stroke.line, marker=stroke.marker,
                label=stroke.label,
            )  # fmt: skip
        axes.set(xscale="log", yscale="log", xlabel="unknowns", ylabel="wall time per load step (ms)")
        axes.tick_params(which="minor", length=0)
        legend_above(axes)

    words = " ".join(
        f"{stroke.name}: {format_number(float(wall.min()), 3)} to {format_number(float(wall.max()), 3)} ms a step from "
        f"{int(unknowns.min())} to {int(unknowns.max())} unknowns."
        for stroke, unknowns, wall in lines
    )
    caption = "Wall milliseconds per load step over the number of unknowns, a dot a run, one thread."
    return Figure.of(draw(paint, WIDE, 350), caption, words, "Growth of compute time")


def _checked(name: str, unknowns: Any, wall: Any) -> tuple[Floats, Floats]:
    across = column(f"unknowns of {name}", unknowns)
    up = column(f"wall time of {name}", wall, len(across))
    if not across.size or not (across > 0).all() or not (up > 0).all():
        raise ValueError(f"unknowns and wall time of {name}: at least one run, all values above zero")
    return across, up
