"""The circle through some markers, frame by frame (the article's Figs. 8 and 10).

The algebraic fit the article uses: x^2 + y^2 + a x + b y + c = 0 by least squares. Through all nine markers of a
block, the middle one included, it is 5.7 % smaller than through the ring of eight.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.vision.displacement.tracks import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Circles:
    """Circles, one per frame.

    Parameters
    ----------
    centre : ndarray, shape (n, 2)
        In the unit of the points; NaN where one of the points is missing: the others would give another circle.
    radius : ndarray, shape (n,)
        Likewise.
    """

    centre: FloatArray
    radius: FloatArray


def fit_circles(points: FloatArray) -> Circles:
    """Fit a circle to the points of each frame.

    Parameters
    ----------
    points : ndarray, shape (n, k, 2)
        At least three points a frame, NaN where missing.
    """
    middle = points.mean(axis=1, keepdims=True)
    whole = np.isfinite(middle).all(axis=(1, 2))
    x, y = np.moveaxis(points[whole] - middle[whole], 2, 0)
    basis = np.stack([x, y, np.ones_like(x)], axis=2)
    square = x * x + y * y
    normal = np.einsum("nki,nkj->nij", basis, basis)
    solved = np.linalg.solve(normal, np.einsum("nki,nk->ni", basis, square)[:, :, None])[:, :, 0]
    offset = 0.5 * solved[:, :2]
    centre, radius = np.full((len(points), 2), np.nan), np.full(len(points), np.nan)
    centre[whole] = middle[whole, 0] + offset
    radius[whole] = np.sqrt(solved[:, 2] + (offset**2).sum(axis=1))
    return Circles(centre, radius)
