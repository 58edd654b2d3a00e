"""The tracking methods: `subpixel`, the default, and `paper`, the article's chain.

`subpixel` measures edges where each marker was last seen, and searches where that fails. `paper` undistorts the
picture, makes it black and white and finds circles (section 3.2.4 of the article: `imfindcircles` finds several at one
marker, and those that overlap are averaged); OpenCV's Hough transform stands for it, and the linking is ours, as the
article does not say how it told markers apart.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.camera.distortion import distort
from bench_hw.vision.camera.pinhole import Camera
from bench_hw.vision.markers.detection import contrast_of, find_blobs
from bench_hw.vision.markers.grid import DetectedGrid, FloatArray, Picture, Sighting
from bench_hw.vision.markers.radial import MarkerEdges, doubted
from bench_hw.vision.tracking.linking import AWAY, GATE, Absences, Neighbours, doubles, link, refuse_jump

_BLOCK = 6.0
_AREAS = (0.35, 2.6)
_CLOSEST = 0.5
_BOTH_WAYS = 2.0
"""Way of a centroid, in radii, for what its outline is drawn out too much: two discs grown together."""
_OTHER_SHAPE = 0.04
"""Drawing out beyond what the neighbours allow, from which a marker is not seen."""
RADIUS_RANGE = (0.6, 1.5)
"""Circles that are looked for, in radii of the markers."""
VOTES = 0.13
"""Votes a circle needs, as a share of the pixels on its circumference: as eager as the article's pictures show."""
_CANNY = 100.0
_CLOSEST_CIRCLES = 1.0


class SubpixelTracker:
    """Follows the markers of a grid through pictures.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture the grid was found in.
    grid : DetectedGrid
        The markers; their numbers are theirs for good.
    camera : Camera
        Whose distortion is taken off.
    """

    def __init__(self, grey: Picture, grid: DetectedGrid, camera: Camera) -> None:
        self._edges = MarkerEdges(grey, grid, camera)
        self._last = grid.centres.copy()
        self._way = np.zeros_like(self._last)
        self._everyone = np.arange(len(grid.centres))
        self._spacing, self._contrast = grid.spacing, contrast_of(grey)
        self._absences, self._neighbours = Absences(AWAY * grid.spacing), Neighbours(self._last, grid.spacing)
        area = np.pi * self._edges.radius**2
        self._areas = (_AREAS[0] * float(area.min()), _AREAS[1] * float(area.max()))
        self._block = round(_BLOCK * grid.radius)

    def step(self, grey: Picture) -> Sighting:
        """Take the next picture.

        Returns
        -------
        Sighting
            Markers that are covered, out of the picture or ambiguous are unseen.

        Raises
        ------
        JumpError
            The whole grid jumped by half its spacing or more.
        """
        sighting = self._plausible(self._edges.look(grey, self._last + self._way, self._everyone))
        if not sighting.seen.all():
            sighting = self._searched(grey, sighting)
        sighting = self._compared(self._absences.checked(sighting))
        self._absences.note(sighting, self._last)
        seen = sighting.seen
        self._way = np.where(seen[:, None], sighting.pixels - self._last, 0.0)
        self._last[seen] = sighting.pixels[seen]
        self._last = self._absences.carried(sighting, self._last)
        return sighting

    def _compared(self, sighting: Sighting) -> Sighting:
        """Leave out markers that went another way than their neighbours, and doubt those drawn out otherwise."""
        strayed = self._neighbours.strayed(sighting.pixels, self._last)
        if strayed.any():
            sighting = sighting.kept(sighting.seen & ~strayed)
        way, stretch = self._neighbours.unlike(sighting.pixels, self._edges.shape[:, 0])
        if not (way.any() or stretch.any()):
            return sighting
        doubt = np.hypot(way, _BOTH_WAYS * stretch * self._edges.radius)
        return doubted(sighting, doubt, stretch < _OTHER_SHAPE)

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
        return self._plausible(sighting.merged(self._edges.look(grey, free[spot], found, searched=True), found))

    def _taken(self, spots: FloatArray, sighting: Sighting) -> NDArray[np.bool_]:
        """Which spots are markers that were seen already."""
        seen = sighting.pixels[sighting.seen]
        if not len(seen) or not len(spots):
            return np.zeros(len(spots), dtype=bool)
        gap = spots[:, None, :] - seen[None, :, :]
        return np.asarray(np.hypot(gap[:, :, 0], gap[:, :, 1]).min(axis=1) < 0.5 * _CLOSEST * self._spacing)


class PaperTracker:
    """Finds the markers of each picture by the article's steps.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture the grid was found in.
    grid : DetectedGrid
        The markers.
    camera : Camera
        Whose distortion is taken off the pictures.
    """

    def __init__(self, grey: Picture, grid: DetectedGrid, camera: Camera) -> None:  # noqa: ARG002 - as every tracker
        self._camera, self._grid = camera, grid
        matrix, lens = camera.matrix, np.array(camera.distortion)
        self._maps = cv2.initUndistortRectifyMap(matrix, lens, np.eye(3), matrix, camera.size, cv2.CV_32FC1)
        self._last = camera.straightened(grid.centres)

    def step(self, grey: Picture) -> Sighting:
        """Take the next picture.

        Returns
        -------
        Sighting
            `confidence` is one over the number of circles that were averaged.

        Raises
        ------
        JumpError
            The whole grid jumped by half its spacing or more.
        """
        circles = find_circles(self.binary(grey), self._grid.radius)
        merged, counts = average_overlapping(circles, self._grid.radius)
        which = link(self._last, merged[:, :2], GATE * self._grid.spacing)
        if np.any(which < 0):
            refuse_jump(self._last, merged[:, :2], self._grid.spacing)
        seen = which >= 0
        self._last[seen] = merged[which[seen], :2]
        return self._sighting(np.where(seen[:, None], merged[which], np.nan), np.where(seen, 1.0 / counts[which], 0.0))

    def binary(self, grey: Picture) -> Picture:
        """Give the undistorted picture in black and white, by Otsu's threshold."""
        straight = cv2.remap(grey, *self._maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(cv2.threshold(straight, 0, 255, cv2.THRESH_BINARY | cv2.THRESH_OTSU)[1], dtype=np.uint8)

    def _sighting(self, circles: FloatArray, confidence: FloatArray) -> Sighting:
        points = self._camera.to_normalised(circles[:, :2])
        pixels = self._camera.to_pixels(distort(points, self._camera.distortion))
        return Sighting(points, pixels, circles[:, 2], confidence)


def find_circles(binary: Picture, radius: float) -> FloatArray:
    """Find circles in a black and white picture.

    Returns
    -------
    ndarray, shape (n, 3)
        Centre x, y and radius, pixels; usually several for each marker.
    """
    low, high = (round(share * radius) for share in RADIUS_RANGE)
    found = cv2.HoughCircles(
        binary,
        cv2.HOUGH_GRADIENT,
        dp=1,
        minDist=_CLOSEST_CIRCLES,
        param1=_CANNY,
        param2=max(4.0, VOTES * 2.0 * np.pi * radius),
        minRadius=max(2, low),
        maxRadius=max(3, high),
    )
    return np.zeros((0, 3)) if found is None else np.asarray(found, dtype=np.float64).reshape(-1, 3)


def average_overlapping(circles: FloatArray, reach: float) -> tuple[FloatArray, FloatArray]:
    """Average each circle, strongest first, with all circles left whose centres are nearer than `reach`.

    Returns
    -------
    circles : ndarray, shape (n, 3)
        Averages, with a last row of NaN that stands for no circle.
    counts : ndarray, shape (n,)
        How many circles each average is of; 1 for the last.
    """
    left, merged, counts = circles, [], []
    while len(left):
        near = np.hypot(*(left[:, :2] - left[0, :2]).T) < reach
        merged.append(left[near].mean(axis=0))
        counts.append(float(near.sum()))
        left = left[~near]
    return np.array([*merged, [np.nan] * 3]), np.array([*counts, 1.0])


class Tracker(Protocol):
    """Follows the markers of one grid; it remembers nothing that grows with the number of pictures."""

    def step(self, grey: Picture) -> Sighting:
        """Take the next picture (the first one, too) and say where the markers are in it."""
        ...


class TrackerMaker(Protocol):
    """Makes a tracker from the picture in which the grid was found."""

    def __call__(self, grey: Picture, grid: DetectedGrid, camera: Camera) -> Tracker:
        """Make it."""
        ...


METHODS: Mapping[str, TrackerMaker] = MappingProxyType({"subpixel": SubpixelTracker, "paper": PaperTracker})
"""`subpixel`, the default, and `paper`, the article's chain."""
