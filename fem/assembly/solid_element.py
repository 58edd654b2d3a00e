"""The three-dimensional elements: shape functions, quadrature and pressure shapes, tabulated.

- `hex27`: triquadratic, linear discontinuous pressure, 27 Gauss points (Q2/P1, inf-sup stable).
- `hex20`: serendipity, 8 Gauss points, no pressure of its own (reduced integration; C3D20R of other programs).
- `tet10`: quadratic, constant pressure, 4 Gauss points on straight sides.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import skfem

from fem.arrays import FloatArray, IntArray


@dataclass(frozen=True)
class SolidElement:
    """One kind of element.

    Attributes
    ----------
    name
        "hex27", "hex20" or "tet10".
    shapes
        scikit-fem's element with the shape functions.
    quadrature_order
        Polynomial order that is integrated exactly.
    pressure_shapes
        How many of 1, xi, eta, zeta the pressure has.
    vtk_type
        Cell type in VTK's numbering.
    vtk_order
        Element nodes in VTK's order.
    middle
        Reference coordinates (3,) of the centroid.
    """

    name: str
    shapes: skfem.Element
    quadrature_order: int
    pressure_shapes: int
    vtk_type: int
    vtk_order: IntArray
    middle: FloatArray

    @property
    def node_places(self) -> FloatArray:
        """Reference coordinates (n, 3) of the nodes."""
        places: FloatArray = self.shapes.doflocs
        return places

    def quadrature(self) -> tuple[FloatArray, FloatArray]:
        """Points (3, q) and weights (q,)."""
        points, weights = skfem.quadrature.get_quadrature(self.shapes, self.quadrature_order)
        return points, weights

    def tabulate(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values (q, n) and derivatives (3 q, n), direction before point, at reference points (3, q)."""
        tables = [self.shapes.lbasis(points, i) for i in range(len(self.node_places))]
        value = np.array([np.broadcast_to(phi, points.shape[1:]) for phi, _ in tables]).T
        gradient = np.array([dphi for _, dphi in tables])
        return value, gradient.transpose(1, 2, 0).reshape(-1, len(tables))

    def monomials(self, points: FloatArray) -> FloatArray:
        """Pressure shapes (p, q) at reference points (3, q), before they are made orthonormal."""
        return np.concatenate((np.ones((1, points.shape[1])), points - self.middle[:, None]))[: self.pressure_shapes]


_HEX_CORNERS = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2))
_HEX_EDGES = (
    *((1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)),
    *((0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)),
)
_HEX_FACES = ((0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2), (1, 1, 1))
_TET = ((0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1))


def _vtk_order(shapes: skfem.Element, halves: tuple[tuple[int, ...], ...]) -> IntArray:
    """Element nodes at VTK's places, given in halves of the reference element."""
    distance = np.abs(2.0 * shapes.doflocs[None, :, :] - np.array(halves)[:, None, :]).max(axis=2)
    order: IntArray = distance.argmin(axis=1)
    return order


def _element(
    name: str,
    shapes: skfem.Element,
    order: int,
    pressure: int,
    vtk_type: int,
    places: tuple[tuple[int, ...], ...],
    middle: float,
) -> SolidElement:
    return SolidElement(name, shapes, order, pressure, vtk_type, _vtk_order(shapes, places), np.full(3, middle))


SOLID_ELEMENTS: Mapping[str, SolidElement] = MappingProxyType(
    {
        "hex27": _element("hex27", skfem.ElementHex2(), 5, 4, 29, (*_HEX_CORNERS, *_HEX_EDGES, *_HEX_FACES), 0.5),
        "hex20": _element("hex20", skfem.ElementHexS2(), 3, 0, 25, (*_HEX_CORNERS, *_HEX_EDGES), 0.5),
        "tet10": _element("tet10", skfem.ElementTetP2(), 2, 1, 24, _TET, 0.25),
    }
)
