"""Values along rows of nodes, corners and mid-sides in turn."""

from __future__ import annotations

import numpy as np

from fem.arrays import FloatArray


def ring_areas(r: FloatArray) -> FloatArray:
    """Area (m,) in m2 of each node of a row at radii r (m,) in m, corners and mid-sides in turn, by Simpson's rule."""
    width = (r[2::2] - r[:-2:2]) / 6.0
    area = np.zeros(len(r))
    area[:-2:2] += width * r[:-2:2]
    area[1:-1:2] = 4.0 * width * r[1:-1:2]
    area[2::2] += width * r[2::2]
    return 2.0 * np.pi * area


def along_row(place: FloatArray, values: FloatArray, r: FloatArray) -> FloatArray:
    """Quadratic interpolation over a row of nodes.

    Parameters
    ----------
    place
        Distances (2 n + 1,) in m of the nodes from the row's start, increasing.
    values
        Values (2 n + 1,) at the nodes.
    r
        Where to interpolate, (m,) in m.

    Returns
    -------
    ndarray
        Values (m,); NaN beyond the end of the row.
    """
    lines = place[::2]
    column = np.clip(np.searchsorted(lines, r, side="right") - 1, 0, len(lines) - 2)
    s = (r - lines[column]) / (lines[column + 1] - lines[column])
    first, middle, last = values[2 * column], values[2 * column + 1], values[2 * column + 2]
    inside = first * (1 - s) * (1 - 2 * s) + middle * 4 * s * (1 - s) + last * s * (2 * s - 1)
    return np.where(r <= lines[-1] * (1 + 1e-12), inside, np.nan)
