"""The best similarity (shift, turn, scale) between two sets of points, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.vision.camera.model import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Similarity:
    """A similarity and what it leaves.

    Parameters
    ----------
    scale : float
        Length of an image over its original's.
    scale_std : float
        Standard deviation of `scale`, as the residuals tell.
    mirrored : bool
        Whether it turns the points over.
    residuals : ndarray, shape (n, 2)
        Points less images.
    """

    scale: float
    scale_std: float
    mirrored: bool
    residuals: FloatArray


def fit_similarity(originals: FloatArray, points: FloatArray) -> Similarity:
    """Fit a similarity from originals to points, both of shape (n, 2), n at least 3, by least squares.

    Written as complex numbers it is w = a z + b, or with the conjugate of z where the points are mirrored.
    """
    z, w = (side[:, 0] + 1j * side[:, 1] for side in (originals, points))
    z, w = z - z.mean(), w - w.mean()
    power = float(np.sum(np.abs(z) ** 2))
    straight, mirrored = np.sum(z.conj() * w) / power, np.sum(z * w) / power
    turned_over = bool(abs(mirrored) > abs(straight))
    factor = mirrored if turned_over else straight
    left = w - factor * (z.conj() if turned_over else z)
    variance = float(np.sum(np.abs(left) ** 2)) / (2 * len(z) - 4)
    residuals = np.stack([left.real, left.imag], axis=1)
    return Similarity(float(abs(factor)), float(np.sqrt(variance / power)), turned_over, residuals)
