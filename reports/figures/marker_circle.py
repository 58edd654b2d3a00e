"""The circle through the markers around the tool, at rest and where it is largest (Fig. 8)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure
from reports.figures.style import FEM, INK, MUTED, TRIAL, WAVE, draw
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

    from reports.figures.arrays import Floats


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
