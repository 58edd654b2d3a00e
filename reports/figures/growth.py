"""How compute time grows with unknowns: a dot a run, both axes logarithmic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from reports.blocks import Figure
from reports.figures.arrays import Floats, column
from reports.figures.pair import DEFAULT, Pair
from reports.figures.style import MEASURED, WIDE, Stroke, draw, legend_above
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing


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
    lines = [(_stroke(name, pair), *_checked(name, *values)) for name, values in runs.items()]

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


def _stroke(name: str, pair: Pair) -> Stroke:
    return {"fem": pair.fem, "wave": pair.wave}.get(name, replace(MEASURED, label=name, name=name))
