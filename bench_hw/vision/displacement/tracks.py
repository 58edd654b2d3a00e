"""Tracks as an array over frames and markers, and how far each marker is from where it rested."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.tables.model import MarkerTable

FloatArray = NDArray[np.float64]


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
