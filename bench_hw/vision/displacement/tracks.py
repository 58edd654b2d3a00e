"""Tracks as an array over frames and markers: displacements, the block of markers around the tool, moving averages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.tables.measurement import MarkerTable

FloatArray = NDArray[np.float64]
Mode = Literal["none", "centred", "causal"]
PAPER_WINDOW = 10
"""Section 3.2.5 of the article: "a window size of 10 and a denominator coefficient of 1"."""


@dataclass(frozen=True, eq=False, slots=True)
class Tracks:
    """Where the markers are over time.

    Parameters
    ----------
    time : ndarray, shape (n,)
        s, strictly increasing.
    places : ndarray, shape (n, m, 2)
        x and y of each marker, m; NaN where it was not seen.
    """

    time: FloatArray
    places: FloatArray


def tracks_of(table: MarkerTable, markers: int | None = None) -> Tracks:
    """Arrange a long table of tracks by frame and marker.

    Parameters
    ----------
    table : MarkerTable
        One row per marker and frame in which it was seen.
    markers : int, optional
        How many there are; by default up to the largest number in the table.

    Raises
    ------
    InputError
        The table names a marker beyond that number.
    """
    largest = int(table.marker.max(initial=-1))
    count = largest + 1 if markers is None else markers
    if largest >= count:
        raise InputError(f"{table.source or 'the tracks'}: marker {largest}; allowed: 0 to {count - 1}")
    time, row = np.unique(table.time, return_inverse=True)
    places = np.full((len(time), count, 2), np.nan)
    places[row, table.marker, 0], places[row, table.marker, 1] = table.x, table.y
    return Tracks(time, places)


def displacements(places: FloatArray, rest: FloatArray | None = None) -> FloatArray:
    """Give how far each marker is from where it rested.

    Parameters
    ----------
    places : ndarray, shape (n, m, 2)
        NaN where a marker was not seen.
    rest : ndarray, shape (m, 2), optional
        Where they rest; by default where each was first seen.

    Returns
    -------
    ndarray, shape (n, m, 2)
        In the unit of `places`; NaN likewise.
    """
    return np.asarray(places - (first_seen(places) if rest is None else rest))


def first_seen(places: FloatArray) -> FloatArray:
    """Give where each marker was first seen, (m, 2); NaN for one that never was."""
    seen = np.isfinite(places).all(axis=2)
    first = seen.argmax(axis=0)
    return np.asarray(places[first, np.arange(places.shape[1])])


def deformation_window(size: FloatArray, share: float = 0.05) -> slice:
    """Give the frames with deformation: from the first to the last above a share of the largest.

    Parameters
    ----------
    size : ndarray, shape (n,)
        How far the sheet is deformed, for instance the mean length of the displacements; NaN where not known.
    share : float
        Of the rise from the smallest to the largest.
    """
    known = np.isfinite(size)
    if not known.any():
        return slice(0, 0)
    low, high = float(np.min(size[known])), float(np.max(size[known]))
    above = np.flatnonzero(known & (np.nan_to_num(size, nan=-np.inf) > low + share * (high - low)))
    return slice(int(above[0]), int(above[-1]) + 1) if len(above) else slice(0, 0)


@dataclass(frozen=True, eq=False, slots=True)
class MarkerBlock:
    """A 3 x 3 block of a grid.

    Parameters
    ----------
    centre : int
        Number of its middle marker, the article's star.
    nine : ndarray of int, shape (9,)
        Row by row.
    ring : ndarray of int, shape (8,)
        Without the middle one.
    """

    centre: int
    nine: NDArray[np.int64]
    ring: NDArray[np.int64]


def inner_nine(rest: FloatArray, rows: int, columns: int, centre: int | None = None) -> MarkerBlock:
    """Choose the 3 x 3 block whose middle is nearest the tool axis, which is the origin; ties towards -x.

    Parameters
    ----------
    rest : ndarray, shape (rows * columns, 2)
        Where the markers rest, m, numbered row by row.
    rows, columns : int
        The grid's layout, at least 3 each.
    centre : int, optional
        Number of the middle marker instead.

    Raises
    ------
    InputError
        No 3 x 3 block fits the grid or lies around that marker, or no marker that could be one was seen.
    """
    if rest.shape != (rows * columns, 2) or min(rows, columns) < 3:
        raise InputError(f"{len(rest)} markers as {rows} x {columns}: allowed is a full grid of at least 3 x 3")
    number = np.arange(rows * columns).reshape(rows, columns)
    inner = number[1:-1, 1:-1].ravel()
    if centre is None:
        centre = _nearest(rest, inner)
    elif centre not in inner:
        raise InputError(f"centre marker {centre}: allowed are those with neighbours all round, {inner.tolist()}")
    row, column = divmod(centre, columns)
    nine = number[row - 1 : row + 2, column - 1 : column + 2].ravel()
    return MarkerBlock(centre, nine, nine[nine != centre])


def _nearest(rest: FloatArray, inner: NDArray[np.int64]) -> int:
    distance = np.hypot(rest[inner, 0], rest[inner, 1])
    if not np.isfinite(distance).any():
        raise InputError("none of the inner markers was ever seen; allowed: at least one")
    nearest = float(np.nanmin(distance))
    tied = inner[distance <= nearest * 1.02 + 1e-12]
    return int(tied[np.argmin(rest[tied, 0])])


def moving_average(values: FloatArray, window: int = PAPER_WINDOW, mode: Mode = "centred") -> FloatArray:
    """Average over frames.

    Parameters
    ----------
    values : ndarray, shape (n, ...)
        NaN where not known; an average with a NaN in its window is NaN.
    window : int
        Frames.
    mode : str
        `centred`: as many frames before as after, the outermost two with half weight where the window is even, a
        shorter window towards the ends; no delay. `causal`: the article's filter (MATLAB's `filter`, which takes
        zeros for what was before the first frame); it delays by (window - 1) / 2 frames and flattens a peak.
        `none`: nothing.

    Raises
    ------
    InputError
        A window below 1, or another mode.
    """
    if window < 1:
        raise InputError(f"a moving average of {window} frames; allowed: at least 1")
    if mode == "none" or window == 1:
        return values.copy()
    if mode == "causal":
        padded = np.concatenate([np.zeros((window - 1, *values.shape[1:])), values])
        return np.asarray(sliding_window_view(padded, window, axis=0).mean(axis=-1))
    if mode == "centred":
        return _centred(values, window)
    raise InputError(f"moving average {mode!r}; allowed: none, centred, causal")


def _centred(values: FloatArray, window: int) -> FloatArray:
    half = window // 2
    weights = np.ones(2 * half + 1)
    if window % 2 == 0:
        weights[[0, -1]] = 0.5
    result = values.copy()
    for row in range(len(values)):
        reach = min(half, row, len(values) - 1 - row)
        part = weights if reach == half else np.ones(2 * reach + 1)
        result[row] = np.tensordot(part / part.sum(), values[row - reach : row + reach + 1], axes=1)
    return result
