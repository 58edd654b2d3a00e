"""Force over depth of one press, FEM against wave."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, LiveAxes, LivePlot
from reports.figures.arrays import Floats, column, last_value, peak, thinned
from reports.figures.live_lines import live_line
from reports.figures.marks import model_line, planned_line, stop_mark
from reports.figures.pair import DEFAULT, Pair
from reports.figures.style import WIDE, Stroke, draw, legend_above
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

Curve = tuple[Floats, Floats]


def force_depth(
    fem_depth_mm: Any,
    fem_force_N: Any,
    wave_depth_mm: Any = None,
    wave_force_N: Any = None,
    planned_peak_N: float | None = None,
    pair: Pair = DEFAULT,
) -> Figure:
    """Draw the tool's force over its depth.

    Parameters
    ----------
    fem_depth_mm, fem_force_N
        The FEM's press, each of shape (n,), press positive; NaN (or nothing) after the step it stopped at.
    wave_depth_mm, wave_force_N
        The wave model's, each of shape (m,); None where it does not cover the case.
    planned_peak_N
        The force the load asked for in N, drawn as a line where the FEM did not reach it.
    pair
        What the two models are called.

    Raises
    ------
    ValueError
        For arrays of other shapes, or infinite values.
    """
    curves = [(_curve("fem", fem_depth_mm, fem_force_N), pair.fem)]
    if wave_depth_mm is not None and wave_force_N is not None:
        curves.append((_curve("wave", wave_depth_mm, wave_force_N), pair.wave))
    reached = peak(curves[0][0][1])
    missed = planned_peak_N is not None and not reached >= 0.999 * planned_peak_N

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots()
        for (depth, force), stroke in curves:
            model_line(axes, depth, force, stroke, stops=False)
        if missed and planned_peak_N is not None:
            _mark_last(axes, *curves[0])
            planned_line(axes, planned_peak_N, f"planned {format_number(planned_peak_N, 3, trim=True)} N")
        axes.set(xlabel="depth (mm)", ylabel="force (N)")
        legend_above(axes)

    lines = [live_line(stroke.label, *curve, stroke.colour, stroke.line) for curve, stroke in curves]
    live = LivePlot("depth (mm)", (LiveAxes("force (N)", lines),))
    caption = f"Force on the tool over its depth: {pair.caption(len(curves) > 1)}."
    caption += f" The {pair.fem.name} run stopped at {format_number(reached, 3)} N." if missed else ""
    words = "; ".join(_words(curve, stroke) for curve, stroke in curves) + "."
    return Figure.of(draw(paint, WIDE, 350), caption, words, "Force over depth", live)


def _curve(name: str, depth_mm: Any, force_N: Any) -> Curve:
    depth = column(f"{name}_depth_mm", depth_mm)
    return thinned(depth, column(f"{name}_force_N", force_N, len(depth)))


def _mark_last(axes: Axes, curve: Curve, stroke: Stroke) -> None:
    depth, force = curve
    last = last_value(force)
    if last is not None:
        stop_mark(axes, float(depth[last]), float(force[last]), stroke)


def _words(curve: Curve, stroke: Stroke) -> str:
    depth, force = curve
    if not np.isfinite(force).any():
        return f"{stroke.label} has no values"
    top = int(np.nanargmax(force))
    return f"{stroke.label} reaches {format_number(float(force[top]), 3)} N at {format_number(float(depth[top]), 3)} mm"
