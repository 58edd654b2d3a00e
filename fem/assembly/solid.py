"""The three-dimensional elements: shape functions, quadrature and pressure shapes, tabulated.

- `hex27`: triquadratic, linear discontinuous pressure, 27 Gauss points (Q2/P1, inf-sup stable).
- `hex20`: serendipity, 8 Gauss points, no pressure of its own (reduced integration; C3D20R of other programs).
- `tet10`: quadratic, constant pressure, 4 Gauss points on straight sides.
- `hex8`, `tet4`: linear, constant pressure, 8 Gauss points and 1: what other codes have, for comparison with them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import skfem

from fem.arrays import FloatArray, IntArray
from fem.assembly.element_geometry import ElementGeometry, orthonormal
from fem.errors import FemError
from fem.materials.components import SOLID, Components
from fem.mesh.solid import SolidMesh

_HEX_CORNERS = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2))
_HEX_EDGES = (
    *((1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)),
    *((0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)),
)
_HEX_FACES = ((0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2), (1, 1, 1))
_TET = ((0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1))


@dataclass(frozen=True)
class SolidElement:
    """One kind of element.

    Attributes
    ----------
    name
        "hex27", "hex20", "tet10", "hex8" or "tet4".
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
        "hex8": _element("hex8", skfem.ElementHex1(), 3, 1, 12, _HEX_CORNERS, 0.5),
        "tet4": _element("tet4", skfem.ElementTetP1(), 1, 1, 10, _TET[:4], 0.25),
    }
)


@dataclass(frozen=True)
class SolidGeometry(ElementGeometry):
    """Factors at q points of E elements with n nodes.

    Attributes
    ----------
    rows
        Derivatives of the shape functions in xi, eta and zeta, (3 q, n).
    inverse
        d(xi, eta, zeta)/d(x, y, z), (3, 3, q, E).
    weight
        Volume of each point with its mirror images, (q, E), in m3.
    pressure
        Pressure shapes (p, q, E), orthonormal in the weight on each element.
    pressure_transform
        Lower triangular (p, p, E): pressure shapes from 1, xi, eta, zeta.
    """

    rows: FloatArray
    inverse: FloatArray
    weight: FloatArray
    pressure: FloatArray
    pressure_transform: FloatArray

    @property
    def components(self) -> Components:
        """All nine."""
        return SOLID

    @property
    def tables(self) -> tuple[FloatArray, ...]:
        """The same rows for each displacement component."""
        return self.rows, self.rows, self.rows

    def gradient(self, u: FloatArray) -> FloatArray:
        """Displacement gradient (9, q, E) of nodal displacements (3 n, E)."""
        q, count = self.weight.shape
        nodes = self.rows.shape[1]
        out = np.empty((3, 3, q, count))
        for i in range(3):
            derivative = (self.rows @ u[i * nodes : (i + 1) * nodes]).reshape(3, q, count)
            np.einsum("aqe,ajqe->jqe", derivative, self.inverse, out=out[i])
        return out.reshape(9, q, count)

    def pull_back(self, stress: FloatArray, elements: slice = slice(None)) -> FloatArray:
        """Reference rows (9, ..., q, E) of components (9, ..., q, E), not weighted."""
        inverse = self.inverse[..., elements]
        tensor = stress.reshape(3, 3, *stress.shape[1:])
        out = np.empty_like(tensor)
        for i in range(3):
            for a in range(3):
                out[i, a] = tensor[i, 0] * inverse[a, 0]
                out[i, a] += tensor[i, 1] * inverse[a, 1]
                out[i, a] += tensor[i, 2] * inverse[a, 2]
        return out.reshape(stress.shape)


def solid_geometry(mesh: SolidMesh) -> SolidGeometry:
    """Geometry at the Gauss points.

    Raises
    ------
    FemError
        If an element has no volume at one of them.
    """
    element = SOLID_ELEMENTS[mesh.element]
    points, weights = element.quadrature()
    rows, inverse, determinant = _mapping(mesh, element, points)
    if determinant.min() <= 0.0:
        e = int(determinant.min(axis=0).argmin())
        x, y, z = mesh.nodes[mesh.elements[:, e]].mean(axis=0)
        raise FemError(f"mesh: element {e} at ({x:g}, {y:g}, {z:g}) m is folded")
    weight = mesh.images * determinant * weights[:, None]
    transform, pressure = orthonormal(element.monomials(points), weight)
    return SolidGeometry(rows, inverse, weight, pressure, transform)


def solid_middle(mesh: SolidMesh, gauss: SolidGeometry) -> SolidGeometry:
    """Geometry at the elements' middles; weights are zero."""
    element = SOLID_ELEMENTS[mesh.element]
    points = element.middle[:, None]
    rows, inverse, determinant = _mapping(mesh, element, points)
    pressure = np.einsum("ije,jq->iqe", gauss.pressure_transform, element.monomials(points))
    return SolidGeometry(rows, inverse, np.zeros_like(determinant), pressure, gauss.pressure_transform)


def _mapping(mesh: SolidMesh, element: SolidElement, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Derivatives (3 q, n), inverse Jacobian (3, 3, q, E) and the determinant (q, E)."""
    _, rows = element.tabulate(points)
    count = mesh.elements.shape[1]
    x = mesh.nodes[mesh.elements].transpose(2, 0, 1)  # (3, n, E)
    J = np.stack([(rows @ x[i]).reshape(3, -1, count) for i in range(3)])  # dx_i/dxi_a
    cofactor = np.empty_like(J)
    for i in range(3):
        for a in range(3):
            k, m, b, c = (i + 1) % 3, (i + 2) % 3, (a + 1) % 3, (a + 2) % 3
            cofactor[i, a] = J[k, b] * J[m, c] - J[k, c] * J[m, b]
    determinant = (J[0] * cofactor[0]).sum(axis=0)
    inverse = cofactor.transpose(1, 0, 2, 3) / determinant
    return rows, np.ascontiguousarray(inverse), determinant
