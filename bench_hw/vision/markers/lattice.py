"""Spots to rows and columns: from neighbour to neighbour, so that a bent or turned grid is followed."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from bench_hw.vision.markers.model import FloatArray, IntArray

_NEAR = (0.7, 1.3)
_CATCH = 0.35
_SIDES = ((0, 1), (0, -1), (1, 0), (-1, 0))


def neighbour_distance(points: FloatArray) -> float:
    """Give the median distance of points (n, 2) from their nearest neighbours; infinite for a single one."""
    if len(points) < 2:
        return float("inf")
    distance, _ = cKDTree(points).query(points, k=2)
    return float(np.median(distance[:, 1]))


def arrange(points: FloatArray) -> IntArray:
    """Give each point its row and column in the largest grid they form.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        In pixels, undistorted best.

    Returns
    -------
    ndarray of int, shape (n, 2)
        Row (downwards) and column (to the right), from 0; -1 for points outside the grid.
    """
    index = np.full((len(points), 2), -1, dtype=np.int64)
    axes = _axes(points)
    if axes is None:
        return index
    largest: dict[int, tuple[int, int]] = {}
    from_middle = np.argsort(np.hypot(*(points - np.median(points, axis=0)).T)).tolist()
    tree, left = cKDTree(points), dict.fromkeys(from_middle)
    while len(left) > len(largest):
        found = _grow(points, tree, axes, next(iter(left)))
        left = {point: None for point in left if point not in found}
        largest = max(largest, found, key=len)
    members = np.array(sorted(largest), dtype=np.int64)
    places = np.array([largest[member] for member in members.tolist()], dtype=np.int64)
    index[members] = places - places.min(axis=0)
    return index


def _axes(points: FloatArray) -> FloatArray | None:
    """The usual steps down a row and along a column, shape (2, 2) by row; None where there is no grid."""
    spacing = neighbour_distance(points)
    if not np.isfinite(spacing) or spacing <= 0.0:
        return None
    pairs = cKDTree(points).query_pairs(_NEAR[1] * spacing, output_type="ndarray")
    steps = points[pairs[:, 1]] - points[pairs[:, 0]]
    steps = steps[np.hypot(steps[:, 0], steps[:, 1]) > _NEAR[0] * spacing]
    if len(steps) < 2:
        return None
    turn = np.angle(np.exp(4j * np.arctan2(steps[:, 1], steps[:, 0])).sum()) / 4.0
    along = np.array([np.cos(turn), np.sin(turn)])
    across = np.array([-along[1], along[0]])
    return np.stack([_usual(steps, across, spacing), _usual(steps, along, spacing)])


def _usual(steps: FloatArray, direction: FloatArray, spacing: float) -> FloatArray:
    """The median of the steps that go more or less in a direction, either way."""
    share = steps @ direction
    chosen: NDArray[np.bool_] = np.abs(share) > 0.85 * np.hypot(steps[:, 0], steps[:, 1])
    if not chosen.any():
        return direction * spacing
    return np.asarray(np.median(steps[chosen] * np.sign(share[chosen])[:, None], axis=0))


def _grow(points: FloatArray, tree: cKDTree, axes: FloatArray, seed: int) -> dict[int, tuple[int, int]]:
    """From a point to its neighbours and on; the step there is the one that led here, where there is one."""
    reach = _CATCH * float(np.hypot(*axes.T).min())
    found, taken = {seed: (0, 0)}, {(0, 0)}
    queue = deque([(seed, axes)])
    while queue:
        at, steps = queue.popleft()
        for side in _SIDES:
            place = (found[at][0] + side[0], found[at][1] + side[1])
            distance, near = tree.query(points[at] + np.array(side) @ steps)
            if place in taken or near in found or distance > reach:
                continue
            found[int(near)] = place
            taken.add(place)
            kind = 0 if side[0] else 1
            new = steps.copy()
            new[kind] = 0.5 * (steps[kind] + (points[near] - points[at]) * sum(side))
            queue.append((int(near), new))
    return found
