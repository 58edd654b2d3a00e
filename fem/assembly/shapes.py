"""Shape functions of the 9-node quadrilateral, tabulated in reference coordinates for matrix products.

Axis-aligned elements need no more than these tables and one factor per component of the gradient:
F_rr = 1 + (du_r/dxi) / width, F_tt = 1 + u_r / r, and so on. The factors are in
:mod:`fem.assembly.geometry`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import skfem

from fem.arrays import FloatArray

NODES = 9


@dataclass(frozen=True)
class Shapes:
    """Tables at q reference points.

    Attributes
    ----------
    points
        Reference coordinates (2, q) in the unit square.
    radial
        Rows d/dxi, d/deta and value of the shape functions at each point, (3 q, 9): acts on u_r.
    vertical
        Rows d/dxi and d/deta at each point, (2 q, 9): acts on u_z.
    """

    points: FloatArray
    radial: FloatArray
    vertical: FloatArray

    @property
    def count(self) -> int:
        """Number of points."""
        return int(self.points.shape[1])


def tabulate(points: FloatArray) -> Shapes:
    """Shape functions of scikit-fem's biquadratic element at reference points (2, q)."""
    element = skfem.ElementQuad2()
    tables = [element.lbasis(points, i) for i in range(NODES)]
    value = np.array([phi for phi, _ in tables]).T
    gradient = np.array([dphi for _, dphi in tables]).transpose(1, 2, 0)
    return Shapes(
        points,
        np.concatenate((gradient[0], gradient[1], value)),
        np.concatenate((gradient[0], gradient[1])),
    )
