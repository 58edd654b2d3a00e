"""Force against depth of one tool on one sheet, and the state that belongs to it, between the equilibria found."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline

from wavemodel.arrays import FloatArray

INVERSIONS = 6


@dataclass(frozen=True)
class Curve:
    """Cubic splines through m equilibria, the first at rest.

    A pull is answered like a press turned round.

    Attributes
    ----------
    depth, force
        (m,) in m and N, rising from zero.
    state
        (m, N) unknowns of the sheet.
    axis
        (m, L) deflection of each layer's top face on the axis, m.
    """

    depth: FloatArray
    force: FloatArray
    state: FloatArray
    axis: FloatArray

    @property
    def reach(self) -> tuple[float, float]:
        """Largest depth (m) and force (N)."""
        return float(self.depth[-1]), float(self.force[-1])

    @cached_property
    def _force(self) -> CubicSpline:
        return CubicSpline(self.depth, self.force)

    @cached_property
    def _slope(self) -> CubicSpline:
        return self._force.derivative()

    @cached_property
    def _axis(self) -> CubicSpline:
        return CubicSpline(self.depth, self.axis)

    @cached_property
    def _state(self) -> CubicSpline:
        return CubicSpline(self.depth, self.state)

    def force_at(self, depth: FloatArray) -> FloatArray:
        """(n,) in N at depths (n,) in m."""
        return np.asarray(np.sign(depth) * self._force(np.abs(depth)))

    def depth_at(self, force: FloatArray) -> FloatArray:
        """(n,) in m at forces (n,) in N: the inverse of `force_at`."""
        size = np.abs(force)
        depth = np.interp(size, self.force, self.depth)
        for _ in range(INVERSIONS):
            depth = depth - (self._force(depth) - size) / self._slope(depth)
        return np.asarray(np.sign(force) * depth)

    def axis_at(self, depth: FloatArray) -> FloatArray:
        """(n, L) deflection of the layers' top faces on the axis, m, at depths (n,) in m."""
        return np.asarray(np.sign(depth)[:, None] * self._axis(np.abs(depth)))

    def state_at(self, depth: float) -> FloatArray:
        """(N,) at a depth in m, not negative."""
        return np.asarray(self._state(depth))
