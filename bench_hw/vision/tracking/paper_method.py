"""The method `paper`, as the article has it: undistort the picture, make it black and white, find circles.

Its section 3.2.4: `imfindcircles` finds several circles at one marker, and those that overlap are averaged. Here
OpenCV's Hough transform stands for it. Only the linking is ours: the article does not say how it told markers apart.
"""

from __future__ import annotations

import cv2
import numpy as np

from bench_hw.vision.camera.distortion import distort
from bench_hw.vision.camera.model import Camera
from bench_hw.vision.markers.model import FloatArray, Grid, Picture
from bench_hw.vision.markers.sighting import Sighting
from bench_hw.vision.tracking.jump import refuse_jump
from bench_hw.vision.tracking.linking import GATE, link

RADIUS_RANGE = (0.6, 1.5)
"""Circles that are looked for, in radii of the markers."""
VOTES = 0.13
"""Votes a circle needs, as a share of the pixels on its circumference: as eager as the article's pictures show."""
_CANNY = 100.0
_CLOSEST_CIRCLES = 1.0


class PaperTracker:
    """Finds the markers of each picture by the article's steps.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture the grid was found in.
    grid : Grid
        The markers.
    camera : Camera
        Whose distortion is taken off the pictures.
    """

    def __init__(self, grey: Picture, grid: Grid, camera: Camera) -> None:  # noqa: ARG002 - as every tracker
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
