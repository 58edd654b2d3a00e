"""Board corners to a camera, by OpenCV's bundle adjustment; k3 is fixed unless asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from bench_hw.vision.calibration.board import Board
from bench_hw.vision.camera.model import Camera, FloatArray

NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
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


def fit_camera(corners: Sequence[FloatArray], board: Board, size: tuple[int, int], free_k3: bool = False) -> Fit:
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
    return Fit(camera, np.ravel(deviations)[:9].astype(np.float64), float(rms), normals)
