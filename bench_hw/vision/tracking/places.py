"""From what a picture tells to what the table says: places in millimetres or pixels, perspective taken off."""

from __future__ import annotations

import numpy as np

from bench_hw.vision.camera.model import Camera, FloatArray
from bench_hw.vision.camera.plane import plane_of, to_plane
from bench_hw.vision.markers.sighting import Sighting
from bench_hw.vision.tracking.sinking import Sinking


class Places:
    """Turns sightings into places.

    Parameters
    ----------
    camera : Camera
        With a plane, unless `pixels`.
    pixels : bool
        Undistorted pixels instead of millimetres.
    sinking : Sinking, optional
        With it, perspective is corrected, and a marker whose depth nobody knows has no place.
    recentre : bool
        Take the middle of the markers of the first picture as the origin.

    Raises
    ------
    InputError
        Millimetres from a camera without mm_per_px.
    """

    def __init__(self, camera: Camera, *, pixels: bool, sinking: Sinking | None, recentre: bool) -> None:
        if not pixels:
            plane_of(camera)
        self._camera, self._pixels, self._sinking = camera, pixels, sinking
        self._recentre = recentre
        self._origin: FloatArray | None = None

    @property
    def unit(self) -> str:
        """`mm` or `px`."""
        return "px" if self._pixels else "mm"

    def of(self, sighting: Sighting, time: float) -> FloatArray:
        """Give the places (m, 2) in the table's unit at an instant (s); NaN where there is none."""
        places = self._measured(sighting, time)
        if not self._recentre:
            return places
        if self._origin is None and np.isfinite(places).all():
            self._origin = places.mean(axis=0)
        return places - (np.nan if self._origin is None else self._origin)

    def _measured(self, sighting: Sighting, time: float) -> FloatArray:
        if self._pixels:
            return self._camera.to_pixels(sighting.points)
        sunk = 0.0 if self._sinking is None else self._sinking.at(time, len(sighting.points))
        return to_plane(self._camera, sighting.points, sunk) * 1e3
