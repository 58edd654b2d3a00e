"""The elastic force-depth curve of a specimen under one tool and support.

A neo-Hookean force is homogeneous of degree one in all moduli, so one curve serves every stiffness factor.
Nothing here computes the curve: a model's depth ramp gives the points.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import scipy
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

BEYOND = 0.01
"""A curve may be continued by this fraction of its last depth, with its slope at the end; not further."""


class ResponseError(ValueError):
    """Curves or faces that are no elastic answer, or a depth beyond them; the message names the value and the limit."""


@dataclass(frozen=True)
class ForceCurve:
    """Force over depth, monotone cubic (PCHIP) between the points, zero for depths <= 0.

    Attributes
    ----------
    depth : (k,) array
        m, increasing, from above 0 (the unloaded state is added) or from 0.
    force : (k,) array
        N, never falling, above 0 at the end.

    Raises
    ------
    ResponseError
        Shapes, order or values that are no such curve.
    """

    depth: Array
    force: Array

    def __post_init__(self) -> None:
        depth, force = np.asarray(self.depth, dtype=float), np.asarray(self.force, dtype=float)
        if depth.ndim != 1 or depth.shape != force.shape or depth.size < 2:
            raise ResponseError(
                f"curve: depth has shape {depth.shape}, force {force.shape}; both need one dimension, one "
                "length and at least 2 points"
            )
        if not (np.isfinite(depth).all() and np.isfinite(force).all()):
            raise ResponseError("curve: depth and force must be finite")
        if depth[0] > 0.0:
            depth, force = np.append(0.0, depth), np.append(0.0, force)
        _check(depth, force)
        object.__setattr__(self, "depth", depth)
        object.__setattr__(self, "force", force)

    @property
    def reach(self) -> float:
        """Deepest depth that may be asked for, m."""
        return float((1.0 + BEYOND) * self.depth[-1])

    def __call__(self, depth: Array) -> Array:
        """Force in N at depths (n,) in m below contact.

        Raises
        ------
        ResponseError
            A depth more than 1 % beyond the curve's end.
        """
        inside, past = self._split(depth)
        return np.asarray(self._spline(inside) + past * self._end_slope)

    def slope(self, depth: Array) -> Array:
        """Return the derivative in N/m at depths (n,) in m, zero in the air; errors as a call."""
        inside, past = self._split(depth)
        slope = np.where(past > 0.0, self._end_slope, self._derivative(inside))
        return np.where(inside > 0.0, slope, 0.0)

    def extended(self, depth: Array) -> Array:
        """Force in N at depths (n,) in m, straight on beyond the last point with the secant of the last two."""
        end = self.depth[-1]
        secant = (self.force[-1] - self.force[-2]) / (end - self.depth[-2])
        return np.asarray(self(np.minimum(depth, end)) + secant * np.maximum(depth - end, 0.0))

    def _split(self, depth: Array) -> tuple[Array, Array]:
        deepest = float(np.max(depth, initial=0.0))
        if deepest > self.reach:
            raise ResponseError(
                f"a depth of {1e3 * deepest:.6g} mm is beyond the force curve, which ends at "
                f"{1e3 * self.depth[-1]:.6g} mm (at most {100 * BEYOND:g} % further is allowed)"
            )
        inside = np.clip(depth, 0.0, self.depth[-1])
        return inside, np.maximum(depth - self.depth[-1], 0.0)

    @cached_property
    def _spline(self) -> Any:
        return scipy.interpolate.PchipInterpolator(self.depth, self.force)

    @cached_property
    def _derivative(self) -> Any:
        return self._spline.derivative()

    @cached_property
    def _end_slope(self) -> float:
        return float(self._derivative(self.depth[-1]))


def _check(depth: Array, force: Array) -> None:
    if depth[0] < 0.0 or force[0] != 0.0:
        raise ResponseError(
            f"curve: starts at {1e3 * depth[0]:.6g} mm with {force[0]:.6g} N; it must start at 0 mm with 0 N, or deeper"
        )
    if (np.diff(depth) <= 0.0).any():
        row = int(np.argmax(np.diff(depth) <= 0.0)) + 1
        raise ResponseError(f"curve: depth must increase, it does not at point {row} ({1e3 * depth[row]:.6g} mm)")
    if (np.diff(force) < 0.0).any():
        row = int(np.argmax(np.diff(force) < 0.0)) + 1
        raise ResponseError(f"curve: force must not fall, it does at point {row} ({force[row]:.6g} N)")
    if force[-1] <= 0.0:
        raise ResponseError("curve: the force at its end is 0 N; a specimen that resists is needed")


def straight_on(x: Array, xs: Array, ys: Array) -> Array:
    """(n,) linear between the points xs, ys (k,), and on beyond the last with the last slope."""
    slope = (ys[-1] - ys[-2]) / (xs[-1] - xs[-2])
    return np.asarray(np.interp(x, xs, ys) + slope * np.maximum(x - xs[-1], 0.0))
