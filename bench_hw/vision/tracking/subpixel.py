"""The method `subpixel`: sub-pixel edges where each marker was last seen, a search where that fails."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.camera.model import Camera
from bench_hw.vision.markers.blobs import contrast_of, find_blobs
from bench_hw.vision.markers.model import FloatArray, Grid, Picture
from bench_hw.vision.markers.radial import MarkerEdges
from bench_hw.vision.markers.sighting import Sighting
from bench_hw.vision.tracking.absence import Absences
from bench_hw.vision.tracking.jump import refuse_jump
from bench_hw.vision.tracking.linking import GATE, doubles, link

_BLOCK = 6.0
_AREAS = (0.35, 2.6)
_CLOSEST = 0.5


class SubpixelTracker:
    """Follows the markers of a grid through pictures.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture the grid was found in.
    grid : Grid
        The markers; their numbers are theirs for good.
    camera : Camera
        Whose distortion is taken off.
    """

    def __init__(self, grey: Picture, grid: Grid, camera: Camera) -> None:
        self._edges = MarkerEdges(grey, grid, camera)
        self._last = grid.centres.copy()
        self._everyone = np.arange(len(grid.centres))
        self._spacing, self._contrast = grid.spacing, contrast_of(grey)
        self._absences = Absences(GATE * grid.spacing)
        area = np.pi * self._edges.radius**2
        self._areas = (_AREAS[0] * float(area.min()), _AREAS[1] * float(area.max()))
        self._block = round(_BLOCK * grid.radius)

    def step(self, grey: Picture) -> Sighting:
        """Take the next picture.

        Returns
        -------
        Sighting
            Markers that are covered, out of the picture or not to be told apart are unseen.

        Raises
        ------
        JumpError
            The whole grid jumped by half its spacing or more.
        """
        sighting = self._plausible(self._edges.look(grey, self._last, self._everyone))
        if not sighting.seen.all():
            sighting = self._searched(grey, sighting)
        sighting = self._absences.checked(sighting)
        self._absences.note(sighting, self._last)
        self._last[sighting.seen] = sighting.pixels[sighting.seen]
        return sighting

    def _plausible(self, sighting: Sighting) -> Sighting:
        """Leave out markers that went beyond the gate, or to another marker's place."""
        way = sighting.pixels - self._last
        with np.errstate(invalid="ignore"):
            inside = np.hypot(way[:, 0], way[:, 1]) < GATE * self._spacing
        chosen = inside & sighting.seen
        chosen &= ~doubles(np.where(chosen[:, None], sighting.pixels, np.nan), self._last, _CLOSEST * self._spacing)
        return sighting if chosen.all() else sighting.kept(chosen)

    def _searched(self, grey: Picture, sighting: Sighting) -> Sighting:
        """Look for the missing markers among the dark spots that are no marker's yet."""
        spots = find_blobs(grey, self._block, self._contrast, self._areas).centres
        free = spots[~self._taken(spots, sighting)]
        seen = sighting.seen
        refuse_jump(self._last, np.concatenate([sighting.pixels[seen], free]), self._spacing)
        missing = np.flatnonzero(~seen)
        spot = link(self._last[missing], free, GATE * self._spacing)
        found, spot = missing[spot >= 0], spot[spot >= 0]
        if not len(found):
            return sighting
        return self._plausible(sighting.merged(self._edges.look(grey, free[spot], found), found))

    def _taken(self, spots: FloatArray, sighting: Sighting) -> NDArray[np.bool_]:
        """Which spots are markers that were seen already."""
        seen = sighting.pixels[sighting.seen]
        if not len(seen) or not len(spots):
            return np.zeros(len(spots), dtype=bool)
        gap = spots[:, None, :] - seen[None, :, :]
        return np.asarray(np.hypot(gap[:, :, 0], gap[:, :, 1]).min(axis=1) < 0.5 * _CLOSEST * self._spacing)
