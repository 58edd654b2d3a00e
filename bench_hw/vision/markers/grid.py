"""What is found in one picture: dark blobs, the grid they form, and where each marker of it was seen."""

from __future__ import annotations

from dataclasses import dataclass, field

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
class DetectedGrid:
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


@dataclass(frozen=True, eq=False, slots=True)
class Sighting:
    """The markers of one picture, in the order of their numbers.

    Parameters
    ----------
    points : ndarray, shape (m, 2)
        Centroids, undistorted and normalised; NaN where a marker was not seen.
    pixels : ndarray, shape (m, 2)
        The same in the picture as it is; NaN likewise.
    radius : ndarray, shape (m,)
        Of a circle of the same area, pixels; NaN likewise.
    confidence : ndarray, shape (m,)
        0 (not seen) to 1.
    error : ndarray, shape (m,) or (0,)
        Standard deviation of a centroid along one axis as the picture's noise and what is covered let it be expected,
        pixels; NaN where a marker was not seen; empty where the method cannot say.
    """

    points: FloatArray
    pixels: FloatArray
    radius: FloatArray
    confidence: FloatArray
    error: FloatArray = field(default_factory=lambda: np.zeros(0))

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Which markers were seen, shape (m,)."""
        return self.confidence > 0.0

    def kept(self, chosen: NDArray[np.bool_]) -> Sighting:
        """Give it with the markers that are not chosen made unseen."""
        hidden = ~chosen
        return Sighting(
            _with_nan(self.points, hidden),
            _with_nan(self.pixels, hidden),
            _with_nan(self.radius, hidden),
            np.where(chosen, self.confidence, 0.0),
            _with_nan(self.error, hidden) if self.error.size else self.error,
        )

    def merged(self, other: Sighting, which: NDArray[np.int64]) -> Sighting:
        """Give it with the markers `which` as another sighting, of just those, has them."""
        arrays = []
        for name in ("points", "pixels", "radius", "confidence", "error"):
            values = getattr(self, name).copy()
            if values.size:
                values[which] = getattr(other, name)
            arrays.append(values)
        return Sighting(*arrays)


def unseen(count: int) -> Sighting:
    """Give a picture in which none of `count` markers was seen."""
    nowhere = np.full((count, 2), np.nan)
    nan = np.full(count, np.nan)
    return Sighting(nowhere, nowhere.copy(), nan, np.zeros(count), nan.copy())


def _with_nan(values: FloatArray, where: NDArray[np.bool_]) -> FloatArray:
    result = values.copy()
    result[where] = np.nan
    return result
