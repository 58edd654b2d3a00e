"""How wrong the map from pixels to undistorted pixels is, judged by views that were not fitted.

The reprojection error says nothing of it: ten views with a free k3 give the same one as twenty with k3 fixed, and a
map that is off by pixels. What is measured here has two parts. What is left to chance: the map is fitted again and
again without some of the views, and how much it changes gives its standard error (the grouped jackknife), over the
part of the picture that the views cover and, where they are extrapolated, over the whole of it. What the model cannot
do: the residuals of held-out views, averaged over fields of the picture, which the corners' noise does not survive.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from bench_hw.vision.calibration.board import Board
from bench_hw.vision.calibration.fit import fit_camera
from bench_hw.vision.calibration.similarity import fit_similarity
from bench_hw.vision.camera.model import Camera, FloatArray

GROUPS = 5
_STEP, _NEARBY = 16, 24.0
_FIELDS = 4
_FEWEST_CORNERS = 10


def all_pixels(size: tuple[int, int]) -> FloatArray:
    """Give a grid of pixels (n, 2) all over a picture of a width and height."""
    x, y = np.arange(0, size[0], _STEP), np.arange(0, size[1], _STEP)
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2).astype(np.float64)


def covered_pixels(corners: Sequence[FloatArray], size: tuple[int, int]) -> FloatArray:
    """Give those pixels (n, 2) of the grid that have a corner of some view nearby."""
    pixels = all_pixels(size)
    distance, _ = cKDTree(np.concatenate(list(corners))).query(pixels)
    return np.asarray(pixels[distance < _NEARBY])


def map_difference(first: Camera, second: Camera, pixels: FloatArray) -> float:
    """Give the rms distance (pixels) of two cameras' maps at some pixels (n, 2), after the best similarity.

    A similarity is what the marker plane's scale, origin and a turn of the camera make of a map anyway. Pixels that
    one of the two cannot undistort are left out.
    """
    one, other = first.undistorted(pixels), second.undistorted(pixels)
    known = np.isfinite(one).all(axis=1) & np.isfinite(other).all(axis=1)
    left = fit_similarity(one[known], other[known]).residuals * first.focal[0]
    return float(np.sqrt((left**2).sum(axis=1).mean()))


@dataclass(frozen=True, slots=True)
class MapError:
    """The error of a map, pixels rms.

    Parameters
    ----------
    chance : float
        Its standard error where the views have corners.
    misfit : float
        What the model cannot do.
    everywhere : float
        The standard error over the whole picture, also where no view has a corner.
    """

    chance: float
    misfit: float
    everywhere: float

    @property
    def total(self) -> float:
        """Chance and misfit together: the error where the views have corners."""
        return float(np.hypot(self.chance, self.misfit))


def held_out_map_error(corners: Sequence[FloatArray], board: Board, camera: Camera, free_k3: bool = False) -> MapError:
    """Estimate the error of a camera's map.

    Parameters
    ----------
    corners : sequence of ndarrays, each of shape (n, 2)
        One per view, at least ten.
    board : Board
        What was photographed.
    camera : Camera
        Fitted to all of them.
    free_k3 : bool
        As in the fit.
    """
    covered, everywhere = covered_pixels(corners, camera.size), all_pixels(camera.size)
    changes: list[tuple[float, float]] = []
    places: list[FloatArray] = []
    left: list[FloatArray] = []
    for group in range(GROUPS):
        kept = [view for index, view in enumerate(corners) if index % GROUPS != group]
        fit = fit_camera(kept, board, camera.size, free_k3).camera
        changes.append((map_difference(camera, fit, covered), map_difference(camera, fit, everywhere)))
        places += corners[group::GROUPS]
        left += [_residuals(view, board, fit) for view in corners[group::GROUPS]]
    chance, extrapolated = np.sqrt((GROUPS - 1) / GROUPS * np.square(changes).sum(axis=0))
    misfit = _lasting(np.concatenate(places), np.concatenate(left), camera.size)
    return MapError(float(chance), misfit, float(extrapolated))


def _residuals(view: FloatArray, board: Board, camera: Camera) -> FloatArray:
    """What is left of a view's undistorted corners after the best homography from the board, pixels (n, 2)."""
    import cv2

    seen = camera.undistorted(view) * camera.focal[0]
    homography, _ = cv2.findHomography(board.points, seen)
    mapped = np.pad(board.points, ((0, 0), (0, 1)), constant_values=1.0) @ np.asarray(homography).T
    return np.asarray(seen - mapped[:, :2] / mapped[:, 2:])


def _lasting(places: FloatArray, left: FloatArray, size: tuple[int, int]) -> float:
    """The rms of the residuals' means over fields of the picture, less what noise leaves of such means."""
    fields = np.floor(places / size * _FIELDS).astype(np.int64)
    number = fields[:, 0] + _FIELDS * fields[:, 1]
    squares, weights = [], []
    for field in np.unique(number):
        rows = left[number == field]
        if len(rows) >= _FEWEST_CORNERS:
            noise = rows.var(axis=0, ddof=1).sum() / len(rows)
            squares.append(float((rows.mean(axis=0) ** 2).sum() - noise))
            weights.append(len(rows))
    return float(np.sqrt(max(0.0, np.average(squares, weights=weights)))) if squares else 0.0
