"""Stress and strain at the middles of the cells, as plain arrays for a file writer.

The memory of layers that relax is followed again there, where the equations do not keep it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.assembly.axisymmetric import Geometry, point_geometry
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.solid import SOLID_ELEMENTS, SolidGeometry, solid_middle
from fem.materials.deformation import Deformation
from fem.materials.element_laws import ElementLaws
from fem.materials.prony import Memory
from fem.mesh.quads import Mesh
from fem.mesh.solid import AnyMesh, SolidMesh

# A 9-node element is written as four linear quads over all its nodes, values at their middles.
QUADS = np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]])
MIDDLES = np.array([[0.25, 0.75, 0.75, 0.25], [0.25, 0.25, 0.75, 0.75]])
VTK_QUAD = 9

_Measures: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]


@dataclass(frozen=True)
class Fields:
    """Fields of one step, z upwards: in the plane theta = 0 with x = r, y = theta, or in three dimensions.

    A mesh with mirror planes shows its half or quarter.

    Attributes
    ----------
    points
        Reference positions (P, 3) in m, top face at z = 0.
    cells
        Points (C, k) of each cell in VTK's order: linear quads, four of which make one axisymmetric
        element, or one quadratic hexahedron or tetrahedron an element.
    layer
        Layer of each cell (C,), 0 on top.
    displacement
        At the points, (P, 3) in m.
    cauchy_stress
        At the cells' middles, (C, 3, 3) in Pa.
    strain
        Green-Lagrange strain (small strain in linear kinematics), (C, 3, 3).
    det_F
        Volume ratio (C,); 1 + trace of the strain in linear kinematics.
    cell_type
        VTK's number of the cells' type.
    """

    points: FloatArray
    cells: IntArray
    layer: IntArray
    displacement: FloatArray
    cauchy_stress: FloatArray
    strain: FloatArray
    det_F: FloatArray
    cell_type: int = VTK_QUAD


@dataclass(frozen=True)
class FieldRecovery:
    """Evaluates fields of a mesh with laws.

    Attributes
    ----------
    mesh
        The mesh.
    laws
        Laws of its elements.
    gauss
        Geometry at the Gauss points.
    point_modulus
        Bulk modulus (E,) in Pa that acts at points (see :class:`fem.assembly.elements.Elements`).
    finite
        Whether the kinematics is finite.
    """

    mesh: AnyMesh
    laws: ElementLaws
    gauss: ElementGeometry
    point_modulus: FloatArray
    finite: bool

    @cached_property
    def _middles(self) -> ElementGeometry:
        """Geometry at the cells' middles."""
        mesh, gauss = self.mesh, self.gauss
        if isinstance(mesh, Mesh) and isinstance(gauss, Geometry):
            return point_geometry(mesh, gauss, MIDDLES)
        if isinstance(mesh, SolidMesh) and isinstance(gauss, SolidGeometry):
            return solid_middle(mesh, gauss)
        raise TypeError("mesh and geometry are of different dimensions")

    def deformation(self, displacement: FloatArray) -> Deformation:
        """Deformation at the cells' middles of nodal displacements (N, components)."""
        count = displacement.shape[1] * len(self.mesh.elements)
        u = displacement[self.mesh.elements].transpose(2, 0, 1).reshape(count, -1)
        return Deformation(self._middles.components, self._middles.gradient(u))

    def fields(self, displacement: FloatArray, pressure: FloatArray) -> Fields:
        """Fields of nodal displacements (N, components) and pressure coefficients (p, E)."""
        geometry, deformation, mesh = self._middles, self.deformation(displacement), self.mesh
        mean_stress = np.einsum("ie,iqe->qe", pressure, geometry.pressure)
        stress, strain, ratio = (_finite if self.finite else _linear)(
            self.laws, deformation, mean_stress, self.point_modulus
        )
        tensor = geometry.components.tensor
        if isinstance(mesh, Mesh):
            cells, kind = mesh.elements[QUADS].transpose(2, 0, 1).reshape(-1, 4), VTK_QUAD
        else:
            element = SOLID_ELEMENTS[mesh.element]
            cells, kind = mesh.elements[element.vtk_order].T, element.vtk_type
        return Fields(
            points=_in_space(mesh.nodes),
            cells=cells,
            layer=np.repeat(mesh.layer, len(ratio)),
            displacement=_in_space(displacement),
            cauchy_stress=_per_cell(tensor(stress)),
            strain=_per_cell(tensor(strain)),
            det_F=_per_cell(ratio),
            cell_type=kind,
        )

    def remembering(self, time: FloatArray, displacement: FloatArray) -> FieldRecovery:
        """The recovery whose laws remember the steps so far, by following them again at the cells' middles.

        Parameters
        ----------
        time
            Times (n,) in s of the steps, at least one.
        displacement
            Nodal displacements (n, N, components) in m.
        """
        if self.laws.prony is None:
            return self
        before = min(0.0, float(time[0]))
        memory = Memory.of_rest(self.laws.prony, self.deformation(displacement[0]).H.shape)
        for end, u in zip(time.tolist(), displacement, strict=True):
            deformation = self.deformation(u)
            elastic = self.laws.second_stress(deformation) if self.finite else self.laws.linear_stress(deformation)
            memory, before = memory.after(end - before, elastic), end
        return replace(self, laws=self.laws.relaxing(*memory.ahead(0.0)))


def _finite(
    laws: ElementLaws, deformation: Deformation, mean_stress: FloatArray, point_modulus: FloatArray
) -> _Measures:
    components = deformation.components
    mean = mean_stress + point_modulus * deformation.volume_change
    P = laws.stress(deformation) + mean * deformation.cofactor
    full = components.tensor(P) @ np.swapaxes(components.tensor(deformation.F), -1, -2)
    cauchy = np.stack([full[..., i, j] for i, j in components.positions]) / deformation.J
    return cauchy, deformation.green_strain, deformation.J


def _linear(
    laws: ElementLaws, deformation: Deformation, mean_stress: FloatArray, point_modulus: FloatArray
) -> _Measures:
    small, components = deformation.small_strain, deformation.components
    change = small[components.normal].sum(axis=0)
    mean = mean_stress + point_modulus * change
    stress = laws.small_stress(deformation) + mean * deformation.identity
    return stress, small, 1.0 + change


def _in_space(plane: FloatArray) -> FloatArray:
    """Vectors (N, 3) of those in (r, z), at theta = 0, or in three dimensions."""
    if plane.shape[1] == 3:
        return plane
    out = np.zeros((len(plane), 3))
    out[:, ::2] = plane
    return out


def _per_cell(values: FloatArray) -> FloatArray:
    """Values (q, E, ...) in the order of the cells, (E q, ...)."""
    return np.swapaxes(values, 0, 1).reshape(-1, *values.shape[2:])
