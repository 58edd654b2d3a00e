"""The scale of the marker plane, from a picture of a board or of a ruler that lies in it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.calibration.board import Board
from bench_hw.vision.calibration.corners import look_for_board, read_picture
from bench_hw.vision.calibration.ruler import measure_ruler
from bench_hw.vision.calibration.similarity import fit_similarity
from bench_hw.vision.camera.model import Camera, FloatArray

LARGEST_TILT = np.radians(2.0)
"""A plane tilted by more than this against the picture is warned of."""


@dataclass(frozen=True, slots=True)
class PlaneScale:
    """What a picture tells about the marker plane.

    Parameters
    ----------
    scale, scale_std : float
        m per undistorted pixel and its standard deviation.
    middle : tuple of 2 floats
        Where the middle of the board or ruler is seen, undistorted pixels.
    kind : str
        `board` or `ruler`.
    warnings : tuple of str
        A sentence each.
    """

    scale: float
    scale_std: float
    middle: tuple[float, float]
    kind: str
    warnings: tuple[str, ...] = ()


def measure_plane(path: Path, board: Board, camera: Camera, mark: float) -> PlaneScale:
    """Measure the scale in a picture of the marker plane.

    Parameters
    ----------
    path : pathlib.Path
        The picture.
    board : Board
        The board, if it shows one.
    camera : Camera
        Takes the distortion off.
    mark : float
        Distance of a ruler's finest marks, m, if it shows one.

    Raises
    ------
    InputError
        It shows neither, or is of another size than the camera's pictures.
    """
    grey = read_picture(path)
    if grey.shape != camera.size[::-1]:
        raise InputError(
            f"{path}: the picture is {grey.shape[1]} x {grey.shape[0]} pixels; "
            f"allowed: {camera.size[0]} x {camera.size[1]}, as the views"
        )
    view = look_for_board(grey, board, str(path))
    if view.corners is not None:
        return _of_board(camera.undistorted(view.corners) * camera.focal[0], board, camera)
    found = measure_ruler(grey, camera, mark)
    if found is None:
        raise InputError(
            f"{path}: neither a board with {board} inner corners ({view.reason}) nor a ruler; "
            "allowed: one of the two, sharp and lying in the marker plane"
        )
    return PlaneScale(found.scale, found.scale_std, found.middle, "ruler")


def _of_board(seen: FloatArray, board: Board, camera: Camera) -> PlaneScale:
    """Scale by the best similarity; its error is that of the fit and of a tilt, which foreshortens by its square."""
    if not np.isfinite(seen).all():
        raise InputError("the board of the plane lies where the camera's distortion has no inverse")
    fit = fit_similarity(board.points, seen)
    tilt = _tilt(seen, board, camera.focal[0])
    scale = 1.0 / fit.scale
    middle = seen.mean(axis=0) / camera.focal[0]
    x, y = camera.to_pixels(middle)
    warnings: tuple[str, ...] = ()
    if tilt > LARGEST_TILT:
        reach = 0.5 * float(np.hypot(*np.ptp(seen, axis=0)))
        spread = 100.0 * np.tan(tilt) * reach / camera.focal[0]
        warnings = (
            f"the plane is tilted by {np.degrees(tilt):.1f} degrees against the picture: the scale is right in the "
            f"middle of the board and changes by {spread:.1g} % to its border; put the camera straight",
        )
    std = float(np.hypot(scale * fit.scale_std / fit.scale, scale * tilt**2 / 4.0))
    return PlaneScale(scale, std, (float(x), float(y)), "board", warnings)


def _tilt(seen: FloatArray, board: Board, focal: float) -> float:
    """Angle (rad) between the board's plane and the picture's, from the homography of its corners."""
    import cv2

    homography = np.asarray(cv2.findHomography(board.points, seen / focal)[0], dtype=np.float64)
    columns = homography / np.linalg.norm(homography[:, 0])
    normal = np.cross(columns[:, 0], columns[:, 1])
    return float(np.arccos(min(1.0, abs(normal[2]) / float(np.linalg.norm(normal)))))
