"""How the markers of one trial moved over time, and the circle around the tool."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, column
from reports.figures.style import FEM, INK, SMALL, TRIAL, WAVE, draw, heading, legend_above, zero_line
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

_AXES = ("x", "y")


def marker_motion(trial: str, time_s: Any, moved_mm: Any) -> Figure:
    """Draw the displacement of each marker along x and y over time, a line a marker.

    Parameters
    ----------
    trial
        Its name.
    time_s
        Instants of the frames, shape (n,).
    moved_mm
        Displacements, shape (n, m, 2), NaN where a marker was not seen.

    Raises
    ------
    ValueError
        For arrays of other shapes.
    """
    time = column("time_s", time_s)
    moved = np.asarray(moved_mm, dtype=np.float64)
    if moved.ndim != 3 or moved.shape[0] != len(time) or moved.shape[2] != 2:
        raise ValueError(f"moved_mm has shape {moved.shape}, allowed: ({len(time)}, markers, 2)")
    panels = [_motion_panel(time, moved[:, :, axis], axis) for axis in range(2)]
    caption = (
        f"Displacement of the {moved.shape[1]} markers of {trial} from where they were first seen, as the camera sees "
        "it (perspective included); a line a marker."
    )
    return Figure(panels, caption, "Marker displacements")


def _motion_panel(time: Floats, moved: Floats, axis: int) -> Panel:
    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots()
        for column_ in moved.T:
            axes.plot(time, column_, color=TRIAL.colour, linewidth=1.0)
        zero_line(axes)
        heading(axes, f"along {_AXES[axis]}", axis)
        axes.set(xlabel="time (s)", ylabel="displacement (mm)")

    largest = float(np.nanmax(np.abs(moved))) if np.isfinite(moved).any() else 0.0
    words = f"Along {_AXES[axis]} the markers move by up to {format_number(largest, 3)} mm."
    return Panel(draw(paint, SMALL, 280), words, f"along {_AXES[axis]}")


def circle_radius(trial: str, time_s: Any, nine_mm: Any, ring_mm: Any, depth_mm: Any = None) -> Figure:
    """Draw how far the circles around the tool have grown over time.

    Parameters
    ----------
    trial
        Its name.
    time_s
        Instants of the frames, shape (n,).
    nine_mm, ring_mm
        Radius of the circle through the nine markers around the tool, and through the ring of eight, shape (n,).
    depth_mm
        Depth of the tool at the frames, shape (n,); drawn under it if given.

    Raises
    ------
    ValueError
        For arrays of other shapes.
    """
    time = column("time_s", time_s)
    radii = {"ring of eight": column("ring_mm", ring_mm, len(time)), "all nine": column("nine_mm", nine_mm, len(time))}
    depth = None if depth_mm is None else column("depth_mm", depth_mm, len(time))
    grown = {name: values - _first(values) for name, values in radii.items()}

    def paint(drawing: Drawing) -> None:
        rows = drawing.subplots(1 if depth is None else 2, 1, sharex=True, squeeze=False)[:, 0]
        for (name, values), stroke in zip(grown.items(), (FEM, WAVE), strict=True):
            rows[0].plot(time, values, color=stroke.colour, linestyle=stroke.line, label=name)
        rows[0].set_ylabel("growth (mm)")
        legend_above(rows[0])
        if depth is not None:
            rows[1].plot(time, depth, color=INK, linewidth=1.2)
            rows[1].set_ylabel("depth (mm)")
        rows[-1].set_xlabel("time (s)")

    words = "; ".join(f"{name} grow by {format_number(float(np.nanmax(v)), 3)} mm" for name, v in grown.items()) + "."
    first = ", ".join(f"{format_number(_first(values), 4)} mm ({name})" for name, values in radii.items())
    caption = f"Growth of the circle around the tool in {trial} over its resting radius of {first}"
    caption += "." if depth is None else "; below, the depth of the tool."
    return Figure.of(draw(paint, height=300 if depth is None else 380), caption, words, "Circle around the tool")


def _first(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(known[0]) if len(known) else float("nan")
