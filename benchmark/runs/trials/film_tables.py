"""The tables of the markers: their displacements over time, a parabola each, and the circle around the tool."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bench_hw.errors import BenchError
from bench_hw.vision.displacement import (
    MarkerBlock,
    deformation_window,
    displacements,
    fit_circles,
    fit_parabolas,
    inner_nine,
)
from benchmark.files.sessions.description import Camera
from benchmark.identification import Film
from benchmark.models import Array

MM = 1e3
AXES = ("x", "y")


@dataclass(frozen=True)
class MarkerMotion:
    """The markers of one trial.

    Attributes
    ----------
    trial : str
    time : (f,) array
        s.
    moved : (f, m, 2) array
        From where each was first seen, m; NaN where not seen. As the camera sees it, perspective included.
    rest : (m, 2) array
        m.
    block : MarkerBlock or None
        The nine markers around the tool; None on a grid without such.
    radius_nine, radius_ring : (f,) array
        Of the circle through the nine, and through the ring of eight, m.
    centre : (f, 2) array
        Of the ring, m.
    window : slice
        Frames with deformation.
    """

    trial: str
    time: Array
    moved: Array
    rest: Array
    block: MarkerBlock | None
    radius_nine: Array
    radius_ring: Array
    centre: Array
    window: slice


def _marker_motion(trial: str, film: Film, camera: Camera) -> MarkerMotion:
    """Work out the motion of a trial's markers."""
    seen = np.isfinite(film.places).all(axis=2)
    rest = film.places[seen.argmax(axis=0), np.arange(film.places.shape[1])]
    moved = displacements(film.places, rest)
    try:
        block = inner_nine(rest, camera.marker_rows, camera.marker_columns, camera.centre_marker)
        nine, ring = (fit_circles(film.places[:, which]) for which in (block.nine, block.ring))
        radii, centre = (nine.radius, ring.radius), ring.centre
    except BenchError:
        empty = np.full(len(film.time), np.nan)
        block, radii, centre = None, (empty, empty), np.full((len(film.time), 2), np.nan)
    size = np.asarray(np.nanmean(np.hypot(moved[..., 0], moved[..., 1]), axis=1))
    return MarkerMotion(trial, film.time, moved, rest, block, *radii, centre, deformation_window(size))


def marker_fits(motions: Sequence[MarkerMotion]) -> dict[str, Any]:
    """Columns of `marker_fits.csv`: displacement in mm = a t^2 + b t + c over the frames with deformation, t in s."""
    names = ("trial", "marker", "axis", "a", "b", "c", "r2")
    rows: list[tuple[Any, ...]] = []
    for motion in motions:
        fits = fit_parabolas(motion.time[motion.window], MM * motion.moved[motion.window])
        for marker in range(motion.moved.shape[1]):
            for axis, label in enumerate(AXES):
                values = (each[marker, axis] for each in (fits.a, fits.b, fits.c, fits.r2))
                rows.append((motion.trial, marker, label, *(float(value) for value in values)))
    return {name: [row[place] for row in rows] for place, name in enumerate(names)}


def circles(motions: Sequence[MarkerMotion]) -> dict[str, Any]:
    """Columns of `circle.csv`: circles through the nine markers and through the ring of eight, whose middle is x, y."""
    whole = [motion for motion in motions if motion.block is not None]

    def joined(values: Sequence[Array]) -> Array:
        return np.concatenate(values) if values else np.empty(0)

    return {
        "trial": [motion.trial for motion in whole for _ in motion.time],
        "time_s": joined([motion.time for motion in whole]),
        "radius_nine_mm": MM * joined([motion.radius_nine for motion in whole]),
        "radius_ring_mm": MM * joined([motion.radius_ring for motion in whole]),
        "x_mm": MM * joined([motion.centre[:, 0] for motion in whole]),
        "y_mm": MM * joined([motion.centre[:, 1] for motion in whole]),
    }


def motions_of(films: Mapping[tuple[str, str], Film], camera: Camera) -> tuple[MarkerMotion, ...]:
    """The motion of every film, in their order."""
    return tuple(_marker_motion(name, film, camera) for (_, name), film in films.items())
