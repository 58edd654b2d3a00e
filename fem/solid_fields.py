"""Stress and strain in the elements of three-dimensional meshes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem.arrays import FloatArray
from fem.assembly import ElementLaws
from fem.assembly.solid_element import SOLID_ELEMENTS
from fem.assembly.solid_geometry import SolidGeometry, solid_middle
from fem.deformation import Deformation
from fem.fields import Fields, stresses
from fem.mesh import SolidMesh


@dataclass(frozen=True)
class SolidFieldRecovery:
    """Evaluates fields of a three-dimensional mesh with laws.

    Attributes
    ----------
    mesh
        The mesh.
    laws
        Laws of its elements.
    gauss
        Geometry at the Gauss points.
    point_modulus
        Bulk modulus (E,) in Pa that acts at points (see :class:`fem.assembly.System`).
    finite
        Whether the kinematics is finite.
    """

    mesh: SolidMesh
    laws: ElementLaws
    gauss: SolidGeometry
    point_modulus: FloatArray
    finite: bool

    @cached_property
    def _middle(self) -> SolidGeometry:
        return solid_middle(self.mesh, self.gauss)

    def deformation(self, displacement: FloatArray) -> Deformation:
        """Deformation at the elements' middles of nodal displacements (N, 3)."""
        u = displacement[self.mesh.elements].transpose(2, 0, 1).reshape(-1, self.mesh.elements.shape[1])
        return Deformation(self._middle.components, self._middle.gradient(u))

    def fields(self, displacement: FloatArray, pressure: FloatArray) -> Fields:
        """Fields of nodal displacements (N, 3) and pressure coefficients (p, E); one quadratic cell an element."""
        geometry, deformation = self._middle, self.deformation(displacement)
        mean_stress = np.einsum("ie,iqe->qe", pressure, geometry.pressure)
        stress, measure, ratio = stresses(self.laws, deformation, mean_stress, self.point_modulus, self.finite)
        element = SOLID_ELEMENTS[self.mesh.element]
        tensor = geometry.components.tensor
        return Fields(
            points=self.mesh.nodes,
            cells=self.mesh.elements[element.vtk_order].T,
            layer=self.mesh.layer,
            displacement=displacement,
            cauchy_stress=tensor(stress)[0],
            strain=tensor(measure)[0],
            det_F=ratio[0],
            cell_type=element.vtk_type,
        )
