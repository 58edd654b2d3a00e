"""The chessboard that is photographed, and its corners in one picture, or the reason why there are none.

OpenCV's sector-based detector finds them to some hundredths of a pixel. Its normalisation of grey levels is left out:
it costs a factor of ten of that accuracy.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.storage.regular_file import DOCUMENT, read_regular
from bench_hw.vision import MOST_PIXELS
from bench_hw.vision.camera.pinhole import FloatArray

_CORNERS = (3, 100)
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


@dataclass(frozen=True, slots=True)
class Board:
    """A chessboard.

    Parameters
    ----------
    columns, rows : int
        Inner corners, 3 to 100 each way.
    square : float
        Side of a square, m.
    """

    columns: int
    rows: int
    square: float

    def __post_init__(self) -> None:
        if not all(_CORNERS[0] <= count <= _CORNERS[1] for count in (self.columns, self.rows)):
            raise InputError(f"corners {self}: allowed are 3x3 to 100x100 inner corners, for instance 9x6")
        if not (math.isfinite(self.square) and 1e-4 <= self.square <= 1.0):
            raise InputError(f"squares of {self.square * 1e3:g} mm: allowed are 0.1 mm to 1000 mm")

    @property
    def points(self) -> FloatArray:
        """The inner corners on the board, shape (rows * columns, 2), row by row, m from its middle."""
        x = (np.arange(self.columns) - (self.columns - 1) / 2.0) * self.square
        y = (np.arange(self.rows) - (self.rows - 1) / 2.0) * self.square
        return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)

    def __str__(self) -> str:
        return f"{self.columns}x{self.rows}"


def parse_corners(text: str, square: float) -> Board:
    """Read `9x6` (inner corners) into a board with squares of `square` m.

    Raises
    ------
    InputError
        It is no such text, or no such board can be.
    """
    columns, _, rows = text.lower().partition("x")
    if not (columns.strip().isdecimal() and rows.strip().isdecimal()):
        raise InputError(f"corners {text!r}: allowed is COLUMNSxROWS of inner corners, for instance 9x6")
    return Board(int(columns), int(rows), square)


@dataclass(frozen=True, eq=False, slots=True)
class BoardView:
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
        data = np.frombuffer(read_regular(path, DOCUMENT), np.uint8)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    try:
        picture = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE) if len(data) else None
    except cv2.error:  # more pixels than any camera has
        picture = None
    if picture is None:
        allowed = f"what OpenCV reads, such as .png, .jpg, .tif, of at most {MOST_PIXELS / 1e6:.0f} million pixels"
        raise InputError(f"{path}: no picture; allowed: {allowed}")
    return np.asarray(picture, dtype=np.uint8)


def look_for_board(grey: Picture, board: Board, name: str) -> BoardView:
    """Find the board in a picture; a view without corners says why not."""
    corners = _accurate_corners(grey, board)
    if corners is None:
        edge = typical_edge(grey)
        if edge > WIDEST_EDGE:
            return BoardView(name, None, f"blurred (edges {edge:.0f} px wide)")
        other = _other_board(grey, board)
        if other:
            return BoardView(name, None, other)
        corners = _tolerant_corners(grey, board)
    if corners is None:
        return BoardView(name, None, "no board")
    return BoardView(name, None, reason) if (reason := _flaw(grey, board, corners)) else BoardView(name, corners)


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
