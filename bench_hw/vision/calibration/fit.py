"""Board corners to a camera, by OpenCV's bundle adjustment (k3 fixed unless asked for), and the error of its map.

The reprojection error says nothing of the map from pixels to undistorted pixels: ten views with a free k3 give the
same one as twenty with k3 fixed, and a map that is off by pixels. What is measured here has two parts. Chance: the map
is fitted again and again without some of the views, and how much it changes gives its standard error (the grouped
jackknife), over the part of the picture that the views cover and, where they are extrapolated, over the whole of it.
Misfit: the residuals of held-out views, averaged over fields of the picture, which the corners' noise does not survive.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from scipy.spatial import cKDTree

from bench_hw.vision.calibration.board import Board
from bench_hw.vision.camera.pinhole import Camera, FloatArray

NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")
GROUPS = 5
_STEP, _NEARBY = 16, 24.0
_FIELDS = 4
_FEWEST_CORNERS = 10


@dataclass(frozen=True, eq=False, slots=True)
class CameraFit:
    """A camera and how well the corners determine it.

    Parameters
    ----------
    camera : Camera
        Without plane and quality.
    deviations : ndarray, shape (9,)
        Standard deviations of fx fy cx cy (pixels) and k1 k2 p1 p2 k3; 0 for a fixed k3.
    reprojection_rms : float
        Pixels.
    normals : ndarray, shape (views, 3)
        The boards' normals as the camera sees them.
    """

    camera: Camera
    deviations: FloatArray
    reprojection_rms: float
    normals: FloatArray


def fit_camera(corners: Sequence[FloatArray], board: Board, size: tuple[int, int], free_k3: bool = False) -> CameraFit:
    """Fit matrix and distortion to corners.

    Parameters
    ----------
    corners : sequence of ndarrays, each of shape (n, 2)
        One per view, pixels, in the order of `Board.points`.
    board : Board
        What was photographed.
    size : tuple of 2 ints
        Width and height of the pictures, pixels.
    free_k3 : bool
        Fit k3, too. It is rarely determined: with few views it changes the map far off the corners by pixels while
        the reprojection error stays the same.
    """
    plane = np.pad(board.points, ((0, 0), (0, 1))).astype(np.float32)
    views = [view.reshape(-1, 1, 2).astype(np.float32) for view in corners]
    rms, matrix, lens, turns, _, deviations, _, _ = cv2.calibrateCameraExtended(
        [plane] * len(views),
        views,
        size,
        np.eye(3),
        np.zeros(5),
        flags=0 if free_k3 else cv2.CALIB_FIX_K3,
        criteria=(cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-10),
    )
    k1, k2, p1, p2, k3 = (float(value) for value in np.ravel(lens)[:5])
    camera = Camera(
        size=size,
        focal=(float(matrix[0, 0]), float(matrix[1, 1])),
        centre=(float(matrix[0, 2]), float(matrix[1, 2])),
        distortion=(k1, k2, p1, p2, k3),
    )
    normals = np.array([cv2.Rodrigues(np.asarray(turn))[0][:, 2] for turn in turns])
    return CameraFit(camera, np.ravel(deviations)[:9].astype(np.float64), float(rms), normals)


@dataclass(frozen=True, eq=False, slots=True)
class Similarity:
    """A similarity and what it leaves.

    Parameters
    ----------
    scale : float
        Length of an image over its original's.
    scale_std : float
        Standard deviation of `scale`, as the residuals tell.
    mirrored : bool
        Whether it turns the points over.
    residuals : ndarray, shape (n, 2)
        Points less images.
    """

    scale: float
    scale_std: float
    mirrored: bool
    residuals: FloatArray


def fit_similarity(originals: FloatArray, points: FloatArray) -> Similarity:
    """Fit a similarity from originals to points, both of shape (n, 2), n at least 3, by least squares.

    Written as complex numbers it is w = a z + b, or with the conjugate of z where the points are mirrored.
    """
    z, w = (side[:, 0] + 1j * side[:, 1] for side in (originals, points))
    z, w = z - z.mean(), w - w.mean()
    power = float(np.sum(np.abs(z) ** 2))
    straight, mirrored = np.sum(z.conj() * w) / power, np.sum(z * w) / power
    turned_over = bool(abs(mirrored) > abs(straight))
    factor = mirrored if turned_over else straight
    left = w - factor * (z.conj() if turned_over else z)
    variance = float(np.sum(np.abs(left) ** 2)) / (2 * len(z) - 4)
    residuals = np.stack([left.real, left.imag], axis=1)
    return Similarity(float(abs(factor)), float(np.sqrt(variance / power)), turned_over, residuals)


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
