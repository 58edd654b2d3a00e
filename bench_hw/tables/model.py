"""The two tables the rest of the product gets from a measurement, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MINIMUM_ROWS = 20
"""A measured table with fewer rows than this is refused."""


@dataclass(frozen=True, eq=False)
class TrialTable:
    """One trial: press force over depth and time.

    Parameters
    ----------
    time : ndarray, shape (n,)
        s, strictly increasing. A row that is missing is a gap, never filled.
    depth : ndarray, shape (n,)
        m, positive into the tissue, as the actuator reports it.
    force : ndarray, shape (n,)
        N, positive when pressing.
    extra : Mapping[str, ndarray], each of shape (n,)
        Further numeric columns in SI units by their names without the unit (`gap` for the column `gap_mm`).
    source : str
        The file the table came from.
    extra_units : Mapping[str, str]
        The unit each extra column had in its file and gets again when written (`{"gap": "mm"}`); an extra
        without an entry has no unit.
    """

    time: FloatArray
    depth: FloatArray
    force: FloatArray
    extra: Mapping[str, FloatArray] = field(default_factory=dict)
    source: str = ""
    extra_units: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class MarkerTable:
    """Marker positions in long form: one row per marker and frame in which it was seen.

    Parameters
    ----------
    time : ndarray, shape (n,)
        s, on the trial's clock at the camera's own instants; strictly increasing for each marker.
    marker : ndarray of int, shape (n,)
        Number of the marker.
    x, y : ndarray, shape (n,)
        m, in the face's plane, origin at the grid's nominal centre.
    source : str
        The file the table came from.
    """

    time: FloatArray
    marker: IntArray
    x: FloatArray
    y: FloatArray
    source: str = ""
