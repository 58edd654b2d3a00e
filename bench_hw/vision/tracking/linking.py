"""Which of the spots seen now is which marker: optimal assignment to where each was seen last.

The gate is just under half the spacing: beyond that a spot could as well be the neighbour. There is no
extrapolation of motion through gaps; where two markers and spots compete, what the markers around did decides.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from bench_hw.vision.markers.model import FloatArray, IntArray

GATE = 0.49
"""Farthest a marker may be from where it was last seen, in spacings."""
_WITNESSES = 4
_FORBIDDEN = 1e9


def link(last: FloatArray, spots: FloatArray, gate: float) -> IntArray:
    """Assign spots to markers.

    Parameters
    ----------
    last : ndarray, shape (m, 2)
        Where each marker was last seen.
    spots : ndarray, shape (k, 2)
        What is seen now, in the same units.
    gate : float
        Longest way between the two.

    Returns
    -------
    ndarray of int, shape (m,)
        Number of each marker's spot, -1 for none.
    """
    result = np.full(len(last), -1, dtype=np.int64)
    if not len(last) or not len(spots):
        return result
    way = spots[None, :, :] - last[:, None, :]
    distance = np.hypot(way[:, :, 0], way[:, :, 1])
    allowed = distance < gate
    cost = np.where(allowed, _settled(last, way, distance, allowed), _FORBIDDEN)
    rows, columns = linear_sum_assignment(cost)
    good = allowed[rows, columns]
    result[rows[good]] = columns[good]
    return result


def _settled(last: FloatArray, way: FloatArray, distance: FloatArray, allowed: NDArray[np.bool_]) -> FloatArray:
    """The distances; in conflicts those left after the usual way of the nearest markers without one."""
    single = (allowed.sum(axis=1) == 1) & (allowed[:, allowed.sum(axis=0) == 1].any(axis=1))
    conflict = allowed.any(axis=1) & ~single
    if not conflict.any() or not single.any():
        return distance
    sure = np.flatnonzero(single)
    increments = way[sure, allowed[sure].argmax(axis=1)]
    result = distance.copy()
    for marker in np.flatnonzero(conflict):
        near = np.argsort(np.hypot(*(last[sure] - last[marker]).T))[:_WITNESSES]
        usual = np.median(increments[near], axis=0)
        left = way[marker] - usual
        result[marker] = np.hypot(left[:, 0], left[:, 1])
    return result


def doubles(places: FloatArray, starts: FloatArray, closest: float) -> NDArray[np.bool_]:
    """Find markers that were measured at the same place as another one.

    Parameters
    ----------
    places : ndarray, shape (m, 2)
        Where the markers were measured; NaN where not.
    starts : ndarray, shape (m, 2)
        Where each was seen last.
    closest : float
        Two markers cannot be closer than this.

    Returns
    -------
    ndarray of bool, shape (m,)
        Those that are not the one the place belongs to by `link`.
    """
    wrong = np.zeros(len(places), dtype=bool)
    seen = np.flatnonzero(np.isfinite(places).all(axis=1))
    gap = places[seen, None, :] - places[None, seen, :]
    close = np.hypot(gap[:, :, 0], gap[:, :, 1]) < closest
    if close.sum() == len(seen):
        return wrong
    taken = np.zeros(len(seen), dtype=bool)
    for index in np.flatnonzero(close.sum(axis=1) > 1):
        if not taken[index]:
            group = close[index]
            taken |= group
            members = seen[group]
            owner = link(starts[members], places[members][:1], np.inf)
            wrong[members[owner < 0]] = True
    return wrong
