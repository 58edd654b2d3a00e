"""OpenCV's five-coefficient distortion, forwards, with its derivative. The inverse lives in `inverse`.

    u = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 x y + p2 (r2 + 2 x^2),    r2 = x^2 + y^2
    v = y (1 + k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 y^2) + 2 p2 x y

(Brown's radial and tangential terms.) Its Jacobian is symmetric.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Coefficients = tuple[float, float, float, float, float]


class Jacobian(NamedTuple):
    """The derivative of the distortion: du/dx, du/dy (equal to dv/dx) and dv/dy, each of the points' shape."""

    xx: FloatArray
    xy: FloatArray
    yy: FloatArray

    @property
    def determinant(self) -> FloatArray:
        """Change of area; the distortion folds over where it becomes zero."""
        return self.xx * self.yy - self.xy * self.xy


def distort(points: FloatArray, coefficients: Coefficients) -> FloatArray:
    """Distort normalised points.

    Parameters
    ----------
    points : ndarray, shape (..., 2)
        Normalised.
    coefficients : tuple of 5 floats
        k1, k2, p1, p2, k3.

    Returns
    -------
    ndarray, shape (..., 2)
        Normalised and distorted.
    """
    k1, k2, p1, p2, k3 = coefficients
    x, y = points[..., 0], points[..., 1]
    xx, yy, xy = x * x, y * y, x * y
    r2 = xx + yy
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    result = np.empty_like(points, dtype=np.float64)
    result[..., 0] = x * radial + 2.0 * p1 * xy + p2 * (r2 + 2.0 * xx)
    result[..., 1] = y * radial + p1 * (r2 + 2.0 * yy) + 2.0 * p2 * xy
    return result


def jacobian(points: FloatArray, coefficients: Coefficients) -> Jacobian:
    """Give the derivative of `distort` at normalised points (..., 2)."""
    k1, k2, p1, p2, k3 = coefficients
    x, y = points[..., 0], points[..., 1]
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3))
    return Jacobian(
        radial + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x,
        x * y * slope + 2.0 * (p1 * x + p2 * y),
        radial + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x,
    )
