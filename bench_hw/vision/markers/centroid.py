"""Area and area centroid of closed outlines, by Green's theorem."""

from __future__ import annotations

import numpy as np

from bench_hw.vision.markers.model import FloatArray


def area_centroids(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give the centroids and areas of polygons.

    Parameters
    ----------
    x, y : ndarray, shape (m, n)
        Corners of m polygons in their order round.

    Returns
    -------
    centroids : ndarray, shape (m, 2)
        NaN for a polygon without area.
    areas : ndarray, shape (m,)
        Not negative.
    """
    x0, y0 = x.mean(axis=1, keepdims=True), y.mean(axis=1, keepdims=True)
    left, up = x - x0, y - y0
    left_next, up_next = _next(left), _next(up)
    cross = left * up_next - left_next * up
    twice = cross.sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = 1.0 / (3.0 * twice)
        centroids = np.stack(
            [
                x0[:, 0] + ((left + left_next) * cross).sum(axis=1) * share,
                y0[:, 0] + ((up + up_next) * cross).sum(axis=1) * share,
            ],
            axis=1,
        )
    return centroids, 0.5 * np.abs(twice)


def fan_centroids(radius: FloatArray, directions: FloatArray) -> FloatArray:
    """Give the centroids of polygons whose corners lie on rays at even angles, from where the rays begin.

    Parameters
    ----------
    radius : ndarray, shape (m, n)
        Distances of the corners.
    directions : ndarray, shape (2, n)
        Cosine and sine of the rays' angles.

    Returns
    -------
    ndarray, shape (m, 2)
        NaN for a polygon without area.
    """
    product = radius * _next(radius)
    before = np.concatenate([product[:, -1:], product[:, :-1]], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((product + before) * radius @ directions.T / (3.0 * product.sum(axis=1))[:, None])


def _next(values: FloatArray) -> FloatArray:
    return np.concatenate([values[:, 1:], values[:, :1]], axis=1)
