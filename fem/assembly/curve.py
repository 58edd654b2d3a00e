"""The deformed lower side of an interface as one smooth curve.

The displacement between the nodes of the row (corners and mid-sides alike) is the cubic spline through all of them: the
curve's tangent and curvature are continuous, so that a node slides from element to element without a kink, and at rest,
where the nodes of both sides coincide, nothing is interpolated. On the axis the radial displacement is odd and the
vertical even; at the outer border the spline is natural.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import solve_banded

from fem.arrays import FloatArray


@dataclass(frozen=True)
class Curve:
    """A row of nodes.

    Attributes
    ----------
    radius
        Radii (n,) in m at rest, increasing from 0 on the axis.
    """

    radius: FloatArray

    def weights(self, s: FloatArray) -> FloatArray | None:
        """Weights of the nodes' displacements in that at a place and its first two derivatives by s.

        Parameters
        ----------
        s
            Places (m,) as radii at rest, in m.

        Returns
        -------
        ndarray or None
            (3 derivatives, 2 components r and z, m, n); None if a place is beyond an end of the row.
        """
        r = self.radius
        if not ((s >= r[0]) & (s <= r[-1])).all():
            return None
        start = np.clip(np.searchsorted(r, s, side="right") - 1, 0, len(r) - 2)
        length = r[start + 1] - r[start]
        b = (s - r[start]) / length
        a, one, zero = 1.0 - b, np.ones_like(b), np.zeros_like(b)
        left = np.stack((a, -one / length, zero))
        right = np.stack((b, one / length, zero))
        left_bend = np.stack(((a**3 - a) * length**2 / 6.0, (1.0 - 3.0 * a * a) * length / 6.0, a))
        right_bend = np.stack(((b**3 - b) * length**2 / 6.0, (3.0 * b * b - 1.0) * length / 6.0, b))
        out = np.stack(
            [left_bend[..., None] * bends[start] + right_bend[..., None] * bends[start + 1] for bends in self._bends],
            axis=1,
        )
        node = np.arange(len(s))
        out[:, :, node, start] += left[:, None]
        out[:, :, node, start + 1] += right[:, None]
        return out

    @cached_property
    def _bends(self) -> tuple[FloatArray, FloatArray]:
        """Second derivatives at the nodes, (n, n) by values there, of the radial and of the vertical displacement."""
        step, count = np.diff(self.radius), len(self.radius)
        right = np.zeros((count, count))
        inner = np.arange(1, count - 1)
        right[inner, inner - 1] = 1.0 / step[:-1]
        right[inner, inner + 1] = 1.0 / step[1:]
        right[inner, inner] = -right[inner, inner - 1] - right[inner, inner + 1]
        bands = np.zeros((3, count))
        bands[0, 2:], bands[2, :-2] = step[1:] / 6.0, step[:-1] / 6.0
        bands[1, 1:-1] = (step[:-1] + step[1:]) / 3.0
        bands[1, [0, -1]] = 1.0
        odd = solve_banded((1, 1), bands, right)
        bands[0, 1], bands[1, 0] = step[0] / 6.0, step[0] / 3.0
        right[0, :2] = np.array([-1.0, 1.0]) / step[0]
        return odd, solve_banded((1, 1), bands, right)
