"""The axisymmetric element: shape functions of the 9-node quadrilateral and its reference geometry.

Shape functions are tabulated in reference coordinates for matrix products. A displacement gradient is made from the
rows d/dxi, d/deta and value of :class:`Shapes` and one factor for each of its components (F_tt = 1 + u_r / r, and so
on); stresses and moduli go the transposed way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import skfem

from fem.arrays import FloatArray
from fem.assembly.element_geometry import ElementGeometry, orthonormal
from fem.materials.components import AXISYMMETRIC, Components
from fem.mesh.quads import Mesh

NODES = 9
QUADRATURE_ORDER = 5  # three Gauss points a direction, none of them on the axis


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


@dataclass(frozen=True)
class Geometry(ElementGeometry):
    """Factors at q points of E elements.

    Attributes
    ----------
    shapes
        Tables at the points.
    inverse
        d(xi, eta)/d(r, z), (2, 2, q, E).
    hoop
        1/r, (q, E).
    weight
        Volume 2 pi r dr dz of each point, (q, E), in m3; at Gauss points its sum is the specimen's volume.
    pressure
        Pressure shapes (3, q, E): 1, xi, eta made orthonormal in the weight on each element.
    pressure_transform
        Lower triangular (3, 3, E): pressure shapes from (1, xi, eta).
    """

    shapes: Shapes
    inverse: FloatArray
    hoop: FloatArray
    weight: FloatArray
    pressure: FloatArray
    pressure_transform: FloatArray

    @property
    def components(self) -> Components:
        """The five components without torsion."""
        return AXISYMMETRIC

    @property
    def tables(self) -> tuple[FloatArray, ...]:
        """Rows of the radial and of the vertical displacement."""
        return self.shapes.radial, self.shapes.vertical

    def gradient(self, u: FloatArray) -> FloatArray:
        """Displacement gradient (5, q, E) of nodal displacements (18, E), radial ones first."""
        shape = self.weight.shape
        radial = (self.shapes.radial @ u[:9]).reshape(3, *shape)
        vertical = (self.shapes.vertical @ u[9:]).reshape(2, *shape)
        (xi_r, xi_z), (eta_r, eta_z) = self.inverse
        out = np.empty((5, *shape))
        out[0] = radial[0] * xi_r + radial[1] * eta_r
        out[1] = radial[0] * xi_z + radial[1] * eta_z
        out[2] = radial[2] * self.hoop
        out[3] = vertical[0] * xi_r + vertical[1] * eta_r
        out[4] = vertical[0] * xi_z + vertical[1] * eta_z
        return out

    def pull_back(self, stress: FloatArray, elements: slice = slice(None)) -> FloatArray:
        """Reference rows (5, ..., q, E) of components (5, ..., q, E), not weighted."""
        (xi_r, xi_z), (eta_r, eta_z) = self.inverse[..., elements]
        out = np.empty_like(stress)
        out[0] = stress[0] * xi_r + stress[1] * xi_z
        out[1] = stress[0] * eta_r + stress[1] * eta_z
        out[2] = stress[2] * self.hoop[..., elements]
        out[3] = stress[3] * xi_r + stress[4] * xi_z
        out[4] = stress[3] * eta_r + stress[4] * eta_z
        return out


def gauss_geometry(mesh: Mesh) -> Geometry:
    """Geometry at the Gauss points."""
    points, weights = skfem.quadrature.get_quadrature(skfem.ElementQuad2(), QUADRATURE_ORDER)
    shapes = tabulate(points)
    inverse, determinant, radius = _mapping(mesh, shapes)
    weight = 2.0 * np.pi * radius * determinant * weights[:, None]
    transform, pressure = orthonormal(_monomials(shapes), weight)
    return Geometry(shapes, inverse, 1.0 / radius, weight, pressure, transform)


def point_geometry(mesh: Mesh, gauss: Geometry, points: FloatArray) -> Geometry:
    """Geometry at other reference points (2, q), off the axis; weights are zero."""
    shapes = tabulate(points)
    inverse, _, radius = _mapping(mesh, shapes)
    pressure = np.einsum("ije,jq->iqe", gauss.pressure_transform, _monomials(shapes))
    return Geometry(shapes, inverse, 1.0 / radius, np.zeros_like(radius), pressure, gauss.pressure_transform)


def _mapping(mesh: Mesh, shapes: Shapes) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Inverse Jacobian (2, 2, q, E), the determinant (q, E) and the radius (q, E)."""
    r, z = mesh.nodes[mesh.elements].transpose(2, 0, 1)
    shape = (shapes.count, r.shape[1])
    r_xi, r_eta, radius = (shapes.radial @ r).reshape(3, *shape)
    z_xi, z_eta = (shapes.vertical @ z).reshape(2, *shape)
    determinant = r_xi * z_eta - r_eta * z_xi
    inverse = np.array([[z_eta, -r_eta], [-z_xi, r_xi]]) / determinant
    return inverse, determinant, radius


def _monomials(shapes: Shapes) -> FloatArray:
    xi, eta = 2.0 * shapes.points - 1.0
    return np.stack((np.ones_like(xi), xi, eta))
