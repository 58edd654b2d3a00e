"""OpenCV's five-coefficient distortion, its derivative, and its inverse, which says where there is nothing to find.

    u = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 x y + p2 (r2 + 2 x^2),    r2 = x^2 + y^2
    v = y (1 + k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 y^2) + 2 p2 x y

(Brown's radial and tangential terms.) Its Jacobian is symmetric. The polynomial folds over at some radius: beyond it
no point is the image of any, and inside every image point also has a second, wrong origin on the far side of the fold.
The inverse, by Newton's method, is the one on the near side: the Jacobian's determinant is positive all the way from
the optical axis to it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Coefficients = tuple[float, float, float, float, float]
TOLERANCE = 1e-12
"""Largest residual of an inverse that counts as found, normalised (6e-10 pixels at a focal length of 600)."""
_STEPS = 60
_LONGEST_STEP = 0.1
_ALONG = np.linspace(0.0, 1.0, 33)[1:]
_BATCH = 4096


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


def undistort(points: FloatArray, coefficients: Coefficients) -> FloatArray:
    """Invert `distort`.

    Parameters
    ----------
    points : ndarray, shape (..., 2)
        Normalised and distorted.
    coefficients : tuple of 5 floats
        k1, k2, p1, p2, k3.

    Returns
    -------
    ndarray, shape (..., 2)
        Normalised, exact to `TOLERANCE`; NaN where the distortion has no inverse.
    """
    target = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    found = np.zeros_like(target)
    active = np.arange(len(target))
    for _ in range(_STEPS):
        step, residual = _newton_step(found[active], target[active], coefficients)
        going = ~(residual <= TOLERANCE)
        found[active[going]] += _shortened(step[going])
        active = active[going]
        if not len(active):
            break
    found[active] = np.nan
    found[~_on_near_side(found, coefficients)] = np.nan
    return found.reshape(np.shape(points))


def undistort_near(
    points: FloatArray, coefficients: Coefficients, start: FloatArray, steps: int = 3, small: float = 1e-5
) -> FloatArray:
    """Invert `distort` close to inverses that are known; fast, without the check of the near side.

    Parameters
    ----------
    points, start : ndarray, shape (..., 2)
        Distorted points, and guesses of their inverses that are good to some hundredths.
    coefficients : tuple of 5 floats
        k1, k2, p1, p2, k3.
    steps : int
        Newton steps; each squares the error.
    small : float
        Bound on the last step, whose square about is the error that is left.

    Returns
    -------
    ndarray, shape (..., 2)
        NaN where the last step was not small.
    """
    found = start
    for _ in range(steps):
        step, _ = _newton_step(found, points, coefficients)
        found = found + step
    found[~(np.abs(step) < small).all(axis=-1)] = np.nan
    return found


def _newton_step(found: FloatArray, target: FloatArray, coefficients: Coefficients) -> tuple[FloatArray, FloatArray]:
    wrong = target - distort(found, coefficients)
    slope = jacobian(found, coefficients)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / slope.determinant
        step = np.empty_like(found)
        step[..., 0] = scale * (slope.yy * wrong[..., 0] - slope.xy * wrong[..., 1])
        step[..., 1] = scale * (slope.xx * wrong[..., 1] - slope.xy * wrong[..., 0])
    return step, np.abs(wrong).max(axis=-1)


def _shortened(step: FloatArray) -> FloatArray:
    """Bound the steps, so that the way from the axis does not leap over the fold; none where there is no step."""
    length = np.hypot(step[:, 0], step[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = np.where(length > _LONGEST_STEP, _LONGEST_STEP / length, 1.0)
        return np.nan_to_num(step * factor[:, None], nan=0.0, posinf=0.0, neginf=0.0)


def _on_near_side(found: FloatArray, coefficients: Coefficients) -> NDArray[np.bool_]:
    near = np.asarray(np.isfinite(found).all(axis=1))
    for first in range(0, len(found), _BATCH):
        part = slice(first, first + _BATCH)
        way = _ALONG[:, None, None] * np.nan_to_num(found[part])
        near[part] &= (jacobian(way, coefficients).determinant > 0.0).all(axis=0)
    return near
