"""The chessboard that is photographed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.camera.model import FloatArray

_CORNERS = (3, 100)


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
