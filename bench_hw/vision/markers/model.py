"""What is found in one picture: dark blobs, and the grid they form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Picture = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Layout:
    """A grid of markers, numbered row by row from 0, left to right and top to bottom in the picture.

    Parameters
    ----------
    rows, columns : int
        At least 1 each, and at least 4 markers in all.
    """

    rows: int
    columns: int

    def __post_init__(self) -> None:
        if min(self.rows, self.columns) < 1 or not 4 <= self.count <= 2500:
            raise InputError(f"a grid of {self}: allowed are 4 to 2500 markers in rows x columns, for instance 3x6")

    @property
    def count(self) -> int:
        """Number of markers."""
        return self.rows * self.columns

    def __str__(self) -> str:
        return f"{self.rows} x {self.columns}"


PAPER_LAYOUT = Layout(3, 6)
"""The 18 markers of the paper's sheet."""


def parse_layout(text: str) -> Layout:
    """Read `3x6` (rows x columns).

    Raises
    ------
    InputError
        It is no such text, or the grid is too small.
    """
    rows, _, columns = text.lower().partition("x")
    if not (rows.strip().isdecimal() and columns.strip().isdecimal()):
        raise InputError(f"grid {text!r}: allowed is ROWSxCOLUMNS, for instance 3x6")
    return Layout(int(rows), int(columns))


@dataclass(frozen=True, eq=False, slots=True)
class Blobs:
    """Dark compact spots of a picture.

    Parameters
    ----------
    centres : ndarray, shape (n, 2)
        Centroids, pixels.
    area : ndarray, shape (n,)
        Square pixels.
    """

    centres: FloatArray
    area: FloatArray

    def __len__(self) -> int:
        return len(self.area)

    def subset(self, chosen: NDArray[np.bool_] | IntArray) -> Blobs:
        """Give some of them, by mask or index."""
        return Blobs(self.centres[chosen], self.area[chosen])


@dataclass(frozen=True, eq=False, slots=True)
class Grid:
    """The markers of a picture in the order of their numbers.

    Parameters
    ----------
    layout : Layout
        Rows and columns as they lie in the picture.
    centres : ndarray, shape (m, 2)
        Pixels.
    radius : float
        Of a circle of the markers' median area, pixels.
    spacing : float
        Median distance of neighbours, pixels.
    strays : int
        Spots of a marker's size that do not belong to the grid.
    """

    layout: Layout
    centres: FloatArray
    radius: float
    spacing: float
    strays: int = 0
