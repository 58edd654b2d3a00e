"""The load over time with the models' answers, and the tool's force over its depth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, LiveAxes, LivePlot
from reports.figures.arrays import Floats, column, last_value, optional_column, peak, stopped_at, thinned
from reports.figures.style import (
    DEFAULT,
    INK,
    WIDE,
    Pair,
    Stroke,
    draw,
    legend_above,
    live_line,
    model_line,
    planned_line,
    stop_mark,
)
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


_AXIS = {"force": "force (N)", "depth": "depth (mm)"}
_OTHER = {"force": "depth", "depth": "force"}
SAME_WAY = 0.003
"""Share of the peak within which the way back lies on the way in, less than the width of a line."""
Curve = tuple[Floats, Floats]


def load_history(
    time_s: Any, load: Any, control: str, fem: Any = None, wave: Any = None, pair: Pair = DEFAULT
) -> Figure:
    """Draw the prescribed load over time and, under it, the answer of the models.

    Parameters
    ----------
    time_s
        Instants of the steps in s, shape (n,).
    load
        Prescribed force in N or depth in mm, shape (n,).
    control
        `force` or `depth`: which of the two is prescribed.
    fem, wave
        The other of the two, depth in mm or force in N, shape (n,), NaN after the step a model stopped
        at; None without the model.
    pair
        What the two models are called.

    Raises
    ------
    ValueError
        For another word than `force` or `depth`, arrays of other shapes, or infinite values.
    """
    if control not in _AXIS:
        raise ValueError(f"control is {control!r}; allowed: {', '.join(_AXIS)}")
    time = column("time_s", time_s)
    load = column("load", load, len(time))
    answers = [
        (values, stroke)
        for values, stroke in (
            (optional_column("fem", fem, len(time)), pair.fem),
            (optional_column("wave", wave, len(time)), pair.wave),
        )
        if values is not None
    ]

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots(2 if answers else 1, 1, sharex=True, squeeze=False)[:, 0]
        few = len(time) <= 150
        axes[0].plot(time, load, color=INK, marker="." if few else "", markersize=3.5, linewidth=1.2)
        axes[0].set_ylabel(_AXIS[control])
        for values, stroke in answers:
            model_line(axes[1], time, values, stroke)
            axes[1].set_ylabel(_AXIS[_OTHER[control]])
        axes[-1].set_xlabel("time (s)")
        legend_above(axes[-1])

    unit = {"force": "N", "depth": "mm"}[control]
    words = f"The prescribed {control} peaks at {format_number(peak(load), 3)} {unit} in {len(time)} steps."
    caption = f"Prescribed {control} over time, a dot a step" if len(time) <= 150 else f"Prescribed {control} over time"
    caption += f"; below, the {_OTHER[control]} the models answer with." if answers else "."
    caption += "".join(
        f" The {stroke.label} stopped early." for values, stroke in answers if stopped_at(values) is not None
    )
    return Figure.of(draw(paint, WIDE, 420 if answers else 260), caption, words, "Load history")


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
        for (depth, force), stroke in once:
            model_line(axes, depth, force, stroke, stops=False)
        if missed and planned_peak_N is not None:
            _mark_last(axes, *curves[0])
            planned_line(axes, planned_peak_N, f"planned {format_number(planned_peak_N, 3, trim=True)} N")
        axes.set(xlabel="depth (mm)", ylabel="force (N)")
        legend_above(axes)

    once = [(_way_in(curve), stroke) for curve, stroke in curves]
    lines = [live_line(stroke.label, *curve, stroke.colour, stroke.line) for curve, stroke in once]
    live = LivePlot("depth (mm)", (LiveAxes("force (N)", lines),))
    caption = f"Force on the tool over its depth: {pair.caption(len(curves) > 1)}."
    retraced = [stroke.name for (curve, stroke), (way, _) in zip(curves, once, strict=True) if way is not curve]
    caption += f" The way back lies on the way in ({' and '.join(retraced)})." if retraced else ""
    caption += f" The {pair.fem.name} run stopped at {format_number(reached, 3)} N." if missed else ""
    words = "; ".join(_words(curve, stroke) for curve, stroke in curves) + "."
    return Figure.of(draw(paint, WIDE, 350), caption, words, "Force over depth", live)


def _curve(name: str, depth_mm: Any, force_N: Any) -> Curve:
    depth = column(f"{name}_depth_mm", depth_mm)
    return thinned(depth, column(f"{name}_force_N", force_N, len(depth)))


def _way_in(curve: Curve) -> Curve:
    """The curve up to its peak where the way back lies on it: drawn twice, dashes of one way fill gaps of the other."""
    depth, force = curve
    if len(depth) < 3 or not np.isfinite([depth, force]).all():
        return curve
    top = int(np.argmax(depth))
    below = np.flatnonzero(depth[top + 1 :] < depth[0])  # the last steps may end below the first one
    back = top + 1 + int(below[0]) if below.size else len(depth)
    way, load = (np.concatenate([each[: back - 1 : -1], each[: top + 1]]) for each in (depth, force))
    if not 0 < top < len(depth) - 1 or (np.diff(way) < 0.0).any():
        return curve
    apart = np.abs(force[top:back] - np.interp(depth[top:back], way, load))
    return (way, load) if apart.max() <= SAME_WAY * np.abs(force).max() else curve


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
