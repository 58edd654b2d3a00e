"""The corners of a board in one picture, or the reason why there are none.

OpenCV's sector-based detector finds them to some hundredths of a pixel. Its normalisation of grey levels is left out:
it costs a factor of ten of that accuracy.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.vision.calibration.board import Board
from bench_hw.vision.camera.model import FloatArray

WIDEST_EDGE = 7.0
"""Pixels from a tenth to nine tenths of an edge; wider is blurred (a sharp webcam picture has 2 to 3)."""
LEAST_CONTRAST = 25.0
"""Grey levels between black and white squares."""
_SMALLEST_PROBE = (3, 3)
_ACCURATE = cv2.CALIB_CB_EXHAUSTIVE | cv2.CALIB_CB_ACCURACY
_TOLERANT = cv2.CALIB_CB_EXHAUSTIVE | cv2.CALIB_CB_NORMALIZE_IMAGE
_REFINED = (5, 5)
_UNTIL = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 50, 1e-4)

Picture = NDArray[np.uint8]


@dataclass(frozen=True, eq=False, slots=True)
class View:
    """A picture of the board.

    Parameters
    ----------
    name : str
        The file.
    corners : ndarray, shape (n, 2), or None
        Pixels, in the order of `Board.points`; None where the picture cannot be used.
    reason : str
        Why it cannot: `blurred (...)`, `no board`, `a board with ...`; empty if it can.
    """

    name: str
    corners: FloatArray | None
    reason: str = ""


def read_picture(path: Path) -> Picture:
    """Read a picture as grey levels.

    Raises
    ------
    InputError
        There is no such file, or it is no picture.
    """
    try:
        data = np.frombuffer(path.read_bytes(), np.uint8)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    picture = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE) if len(data) else None
    if picture is None:
        raise InputError(f"{path}: no picture; allowed: what OpenCV reads, such as .png, .jpg, .tif")
    return np.asarray(picture, dtype=np.uint8)


def look_for_board(grey: Picture, board: Board, name: str) -> View:
    """Find the board in a picture; a view without corners says why not."""
    corners = _accurate_corners(grey, board)
    if corners is None:
        edge = typical_edge(grey)
        if edge > WIDEST_EDGE:
            return View(name, None, f"blurred (edges {edge:.0f} px wide)")
        other = _other_board(grey, board)
        if other:
            return View(name, None, other)
        corners = _tolerant_corners(grey, board)
    if corners is None:
        return View(name, None, "no board")
    return View(name, None, reason) if (reason := _flaw(grey, board, corners)) else View(name, corners)


def _accurate_corners(grey: Picture, board: Board) -> FloatArray | None:
    there, corners = cv2.findChessboardCornersSB(grey, (board.columns, board.rows), flags=_ACCURATE)
    return np.asarray(corners, dtype=np.float64).reshape(-1, 2) if there else None


def _tolerant_corners(grey: Picture, board: Board) -> FloatArray | None:
    """The corners in a picture of poor contrast, refined by the grey levels around them."""
    there, corners = cv2.findChessboardCornersSB(grey, (board.columns, board.rows), flags=_TOLERANT)
    if not there:
        return None
    refined = cv2.cornerSubPix(grey, corners, _REFINED, (-1, -1), _UNTIL)
    return np.asarray(refined, dtype=np.float64).reshape(-1, 2)


def _flaw(grey: Picture, board: Board, corners: FloatArray) -> str:
    points = corners.reshape(-1, 1, 2).astype(np.float32)
    sharpness = cv2.estimateChessboardSharpness(grey, (board.columns, board.rows), points)[0]
    edge, black, white, _ = (float(value) for value in np.ravel(np.asarray(sharpness)))
    if white - black < LEAST_CONTRAST:
        return f"too little contrast ({white - black:.0f} grey levels)"
    return "" if edge <= WIDEST_EDGE else f"blurred (edges {edge:.1f} px wide)"


def _other_board(grey: Picture, board: Board) -> str:
    flags = _ACCURATE | cv2.CALIB_CB_LARGER
    there, _, meta = cv2.findChessboardCornersSBWithMeta(grey, _SMALLEST_PROBE, flags)
    if not there or meta is None:
        return ""
    long, short = max(meta.shape[:2]), min(meta.shape[:2])
    same = (long, short) == (max(board.columns, board.rows), min(board.columns, board.rows))
    return "" if same else f"a board with {long}x{short} inner corners"


def typical_edge(grey: Picture) -> float:
    """Estimate how wide the sharpest edges of a picture are, pixels: contrast over steepest slope."""
    smooth = cv2.GaussianBlur(grey.astype(np.float32), (0, 0), 1.0)
    slope = np.hypot(cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=0.125), cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=0.125))
    dark, bright = np.percentile(smooth, (3.0, 97.0))
    return float((bright - dark) / max(float(np.percentile(slope, 99.8)), 1e-6))
