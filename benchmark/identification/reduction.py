"""Which rows of a long trial are averaged together: neighbours, and in a trial of many cycles never across a turn.

A mean over a good part of a cycle is a depth and a force that were never measured together. Where a trial has more
strokes (from one turn of the depth to the next) than an even share of rows can follow, some of its cycles stand for
all, evenly over the record, each followed closely.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from benchmark.response.force_curve import Array

IntArray = NDArray[np.int64]

TURN: Final = 0.2
"""Share of the travel by which the depth goes back before that counts as a turn."""
PER_STROKE: Final = 40
"""Rows with which a stroke is followed: each a fortieth of the travel."""
SAMPLES: Final = 200_000
"""Means over the record in which turns are looked for."""


def group_bounds(depth: Array, rows: int) -> tuple[IntArray, IntArray]:
    """First rows of the groups to average and the rows after their last, at most about `rows` groups.

    Parameters
    ----------
    depth : (n,)
        m, n above `rows`.
    rows : int
        At least 40.
    """
    turns = turning_rows(depth)
    if (len(turns) - 1) * PER_STROKE <= rows:
        starts = np.arange(0, len(depth), -(-len(depth) // rows))
        return starts, np.append(starts[1:], len(depth))
    first, last = _chosen_strokes(turns, max(rows // PER_STROKE, 2))
    shares = np.linspace(0.0, 1.0, PER_STROKE + 1)
    edges = np.unique(np.round(first[:, None] + shares * (last - first)[:, None]).astype(np.int64), axis=1)
    starts, ends = edges[:, :-1].ravel(), edges[:, 1:].ravel()
    return starts[ends > starts], ends[ends > starts]


def turning_rows(depth: Array) -> IntArray:
    """Rows in which strokes begin and end: the first, each turn of the depth (n,) m, and the one after the last."""
    size = -(-len(depth) // SAMPLES)
    starts = np.arange(0, len(depth), size)
    means = np.add.reduceat(depth, starts) / np.diff(np.append(starts, len(depth)))
    least = TURN * float(np.ptp(means))
    turns, extreme, sign = [0], 0, 0
    for at, value in enumerate(means.tolist()):
        gone = value - float(means[extreme])
        if sign * gone >= 0.0 and (sign or abs(gone) >= least):
            sign, extreme = sign or (1 if gone > 0.0 else -1), at
        elif sign and abs(gone) >= least:
            turns.append(extreme * size)
            sign, extreme = -sign, at
    return np.array([*turns, len(depth)], dtype=np.int64)


def _chosen_strokes(turns: IntArray, most: int) -> tuple[IntArray, IntArray]:
    """First and last rows of `most` strokes: pairs of neighbours, loading and unloading, evenly over the record."""
    strokes = len(turns) - 1
    pairs = np.unique(np.round(np.linspace(0, strokes - 2, most // 2)).astype(np.int64))
    chosen = np.unique(np.concatenate([pairs, pairs + 1]))
    return turns[chosen], turns[chosen + 1]
