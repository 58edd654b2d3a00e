"""Reference geometry of the three-dimensional elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.solid_element import SOLID_ELEMENTS, SolidElement
from fem.components import SOLID, Components
from fem.errors import FemError
from fem.mesh import SolidMesh


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
    monomials = element.monomials(points)
    mass = np.einsum("iq,jq,qe->eij", monomials, monomials, weight)
    transform = np.ascontiguousarray(np.linalg.inv(np.linalg.cholesky(mass)).transpose(1, 2, 0))
    pressure = np.einsum("ije,jq->iqe", transform, monomials)
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
