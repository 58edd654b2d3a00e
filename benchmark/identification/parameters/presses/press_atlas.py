"""The elastic force of one set-up over wide ranges of the parameters: all presses that were solved, put together.

Each press gives the logarithm of the force and its derivatives at one point. Between the points the logarithm is
that of the newest press to first order, plus a gradient-enhanced radial interpolant of what is left, so that values and
derivatives are met at every point (Morris, Mitchell and Ylvisaker 1993, Technometrics 35:243). Away from all points
the first order remains.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from benchmark.identification.parameters.presses.press_surrogate import PressSurrogate
from benchmark.response.force_curve import Array

RANGE = 2.0
"""Length over which presses speak for each other, in logarithms of the parameters: a factor of seven."""
NEAR = 0.01
"""Presses closer than this in every coordinate say the same; the newer one stays."""
NUGGET = 1e-9
"""Variance of a value's error over that of the interpolant: what steps of a press and its spline leave."""
MOST = 40
"""Presses kept, the newest ones."""


@dataclass(frozen=True, eq=False)
class PressAtlas:
    """Presses of one set-up at several points; the last one is the newest.

    Attributes
    ----------
    presses : tuple of PressSurrogate
    curved : (a,) int array
        Coordinates in which the logarithm of the force is no straight line: those of the model's parameters.
    """

    presses: tuple[PressSurrogate, ...]
    curved: NDArray[np.int64]

    @property
    def newest(self) -> PressSurrogate:
        """The press round which first order is taken."""
        return self.presses[-1]

    @property
    def depth(self) -> Array:
        """(k,) m, even, from 0."""
        return self.newest.depth

    @property
    def layers(self) -> Mapping[str, Array]:
        """Derivatives of the force's logarithm by relaxing layers' stiffness, at the newest press."""
        return self.newest.layers

    def with_press(self, press: PressSurrogate) -> PressAtlas:
        """The atlas with one more press, in the place of those that stand where it does."""
        own = press.at[self.curved]
        kept = [one for one in self.presses if np.abs(one.at[self.curved] - own).max(initial=0.0) > NEAR]
        return PressAtlas((*kept, press)[-MOST:], self.curved)

    def away(self, vector: Array) -> float:
        """How far a point (p,) is from the nearest press: the length of its logarithms."""
        own = vector[self.curved]
        return min(float(np.linalg.norm(one.at[self.curved] - own)) for one in self.presses)

    def force_at(self, vector: Array) -> Array:
        """(k,) N at the depths of the grid, at coordinates (p,)."""
        plain = self.newest.force_at(vector)
        weights = self._weights
        if weights is None:
            return plain
        own = weights[:, : self.depth.size]
        return np.asarray(plain * np.exp(_values(vector[self.curved] - self._points).ravel() @ own))

    def rings_at(self, vector: Array) -> Array:
        """(s, k) m of the markers' rings on the grid of depths, at coordinates (p,)."""
        plain, weights = self.newest.rings_at(vector), self._weights
        if weights is None or not plain.size:
            return plain
        added = _values(vector[self.curved] - self._points).ravel() @ weights[:, self.depth.size :]
        return np.asarray(plain + added.reshape(plain.shape))

    def rings_by_at(self, vector: Array) -> Array:
        """(p, s, k) derivatives of the rings' motion by the coordinates, m."""
        plain, weights = self.newest.rings_by_at(vector), self._weights
        if weights is None or not plain.size:
            return plain
        gradients = _gradients(vector[self.curved] - self._points).reshape(self.curved.size, -1)
        out = plain.copy()
        out[self.curved] += (gradients @ weights[:, self.depth.size :]).reshape(-1, *plain.shape[1:])
        return out

    def by_at(self, vector: Array) -> Array:
        """(p, k) derivatives of the force's logarithm by the coordinates."""
        weights = self._weights
        if weights is None:
            return self.newest.by
        out = self.newest.by.copy()
        gradients = _gradients(vector[self.curved] - self._points)
        out[self.curved] += gradients.reshape(self.curved.size, -1) @ weights[:, : self.depth.size]
        return out

    def curve(self, grid: Array, depth: Array) -> Array:
        """(..., n) of quantities on the grid (..., k) at depths (n,), m."""
        return self.newest.curve(grid, depth)

    @cached_property
    def _points(self) -> Array:
        return np.array([one.at[self.curved] for one in self.presses])

    @cached_property
    def _weights(self) -> Array | None:
        """(m (1 + a), k + s k) weights of the radial functions and their derivatives; None with one press alone.

        The first k are of the force's logarithm, the others of the rings' motion.
        """
        if len(self.presses) < 2 or self.curved.size == 0:
            return None
        away = self._points[:, None, :] - self._points[None, :, :]
        count, size = len(self.presses), 1 + self.curved.size
        matrix = np.empty((count, size, count, size))
        for row in range(count):
            matrix[row, 0] = _values(away[row])
            matrix[row, 1:] = np.moveaxis(_gradients(away[row]), 0, 0)
        left = np.array([self._left(one) for one in self.presses])
        flat = matrix.reshape(count * size, count * size)
        flat[np.diag_indices_from(flat)] += NUGGET
        return np.asarray(np.linalg.solve(flat, left.reshape(count * size, -1)))

    def _left(self, one: PressSurrogate) -> Array:
        """(1 + a, k + s k) what first order round the newest press leaves of a press, and of its derivatives."""
        first = np.zeros_like(one.force)
        first[1:] = np.log(one.force[1:] / self.newest.force_at(one.at)[1:])
        first[0] = first[1]
        force = np.vstack([first, one.by[self.curved] - self.newest.by[self.curved]])
        moved = (one.rings - self.newest.rings_at(one.at)).reshape(1, -1)
        slopes = (one.rings_by_at(one.at) - self.newest.rings_by_at(one.at))[self.curved]
        return np.hstack([force, np.vstack([moved, slopes.reshape(self.curved.size, -1)])])


def _values(away: Array) -> Array:
    """(m, 1 + a) radial functions, and their derivatives by their own points, at distances (m, a) from the points."""
    bell = np.exp(-0.5 * np.sum((away / RANGE) ** 2, axis=1))
    return np.column_stack([bell, bell[:, None] * away / RANGE**2])


def _gradients(away: Array) -> Array:
    """(a, m, 1 + a) derivatives of `_values` by the place."""
    count, size = away.shape
    bell = np.exp(-0.5 * np.sum((away / RANGE) ** 2, axis=1))
    out = np.empty((size, count, 1 + size))
    out[:, :, 0] = (-bell[:, None] * away / RANGE**2).T
    outer = np.einsum("mi,mj->imj", away, away) / RANGE**4
    out[:, :, 1:] = bell[None, :, None] * (np.eye(size)[:, None, :] / RANGE**2 - outer)
    return out
