"""How the markers of one trial moved: displacements over time, and the circle around the tool (Fig. 8)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, column
from reports.figures.style import FEM, INK, MUTED, SMALL, TRIAL, WAVE, draw, heading, legend_above, zero_line
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

    from reports.figures.arrays import Floats


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


@dataclass(frozen=True)
class Ring:
    """A circle, all in mm: its name, centre and radius."""

    name: str
    x: float
    y: float
    radius: float


def marker_circle(trial: str, places_mm: Any, chosen: Sequence[int], star: int, rest: Ring, largest: Ring) -> Figure:
    """Draw the centres of all markers, a star at the one nearest to the tool, and two circles.

    Parameters
    ----------
    trial
        Its name.
    places_mm
        Centres of the markers where the circle is largest, shape (m, 2), NaN where one was not seen.
    chosen
        Numbers of the markers that the circles go through.
    star
        Number of the marker nearest to the tool axis.
    rest, largest
        The circle at rest and the largest one.

    Raises
    ------
    ValueError
        For an array of another shape.
    """
    places = np.asarray(places_mm, dtype=np.float64)
    if places.ndim != 2 or places.shape[1] != 2:
        raise ValueError(f"places_mm has shape {places.shape}, allowed: (markers, 2)")

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots()
        _points(axes, places, chosen, star)
        for ring, stroke in ((rest, WAVE), (largest, FEM)):
            angle = np.linspace(0.0, 2.0 * np.pi, 181)
            across, up = ring.x + ring.radius * np.cos(angle), ring.y + ring.radius * np.sin(angle)
            axes.plot(across, up, color=stroke.colour, linestyle=stroke.line, label=ring.name)
        axes.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal")
        drawing.legend(loc="outside lower left", ncols=3)

    sizes = " and ".join(f"{format_number(ring.radius, 4)} mm {ring.name}" for ring in (rest, largest))
    caption = (
        f"Centres of the {len(places)} markers of {trial} where the circle through the {len(chosen)} around the tool "
        f"is largest; the star is the marker nearest to the tool axis. Its radius is {sizes}."
    )
    words = f"A grid of {len(places)} points; circles of {sizes} around the starred one."
    return Figure.of(draw(paint, height=370), caption, words, "The circle around the tool")


def _points(axes: Axes, places: Floats, chosen: Sequence[int], star: int) -> None:
    others = [number for number in range(len(places)) if number not in set(chosen)]
    around = [number for number in chosen if number != star]
    axes.plot(*places[others].T, "o", color=MUTED, markersize=5, fillstyle="none", label="other markers")
    axes.plot(*places[around].T, TRIAL.marker, color=INK, markersize=5, label="markers of the circle")
    axes.plot(*places[star], "*", color=INK, markersize=13, label="marker nearest to the tool")
