"""Triangles that cross each other."""

from __future__ import annotations

import numpy as np

from fem.arrays import BoolArray, FloatArray
from fem.mesh.surface.model import Surface

AT_ONCE = 200_000


def crossing_triangles(surface: Surface) -> FloatArray | None:
    """A place (3,) in m where an edge of one triangle goes through another, or None.

    Only triangles without a common corner are looked at: neighbours meet at their edge.
    """
    from scipy.spatial import cKDTree  # loaded here: it doubles the start of runs that have no surface

    corners = surface.corners
    centre = corners.mean(axis=1)
    reach = np.linalg.norm(corners - centre[:, None], axis=2).max(axis=1)
    order = np.argsort(reach)
    tree = cKDTree(centre)
    for part in np.array_split(order, max(1, len(order) // 2000)):
        near = tree.query_ball_point(centre[part], reach[part] + reach.max())
        first = np.repeat(part, [len(found) for found in near])
        second = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
        gap = np.linalg.norm(centre[first] - centre[second], axis=1)
        close = (first != second) & (gap <= reach[first] + reach[second])
        first, second = first[close], second[close]
        shared = (surface.triangles[first][:, :, None] == surface.triangles[second][:, None, :]).any(axis=(1, 2))
        first, second = first[~shared], second[~shared]
        for start in range(0, len(first), AT_ONCE):
            a, b = corners[first[start : start + AT_ONCE]], corners[second[start : start + AT_ONCE]]
            for k in range(3):
                hit = _through(a[:, k], a[:, (k + 1) % 3], b)
                if hit.any():
                    return np.asarray(b[hit][0].mean(axis=0))
    return None


def _through(start: FloatArray, end: FloatArray, triangle: FloatArray) -> BoolArray:
    """Whether segments (m, 3) pass through the inside of triangles (m, 3, 3), by signed volumes."""
    a, b, c = triangle.transpose(1, 0, 2)
    below, above = _volume(start, a, b, c), _volume(end, a, b, c)
    sides = [_volume(start, end, p, q) for p, q in ((a, b), (b, c), (c, a))]
    same = np.all([s > 0.0 for s in sides], axis=0) | np.all([s < 0.0 for s in sides], axis=0)
    out: BoolArray = (below * above < 0.0) & same
    return out


def _volume(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    out: FloatArray = np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a))
    return out
