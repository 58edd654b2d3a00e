"""Stress and strain at the parts of the elements, as plain arrays for a file writer."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol, TypeAlias, TypeVar

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.assembly.axisymmetric import Geometry, point_geometry
from fem.assembly.solid import SOLID_ELEMENTS, SolidGeometry, solid_middle
from fem.materials.components import AXISYMMETRIC
from fem.materials.deformation import Deformation
from fem.materials.element_laws import ElementLaws
from fem.materials.prony import Memory
from fem.mesh.quads import Mesh
from fem.mesh.solid import SolidMesh

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
        Bulk modulus (E,) in Pa that acts at points (see :class:`fem.assembly.System`).
    finite
        Whether the kinematics is finite.
    """

    mesh: Mesh
    laws: ElementLaws
    gauss: Geometry
    point_modulus: FloatArray
    finite: bool

    @cached_property
    def _middles(self) -> Geometry:
        return point_geometry(self.mesh, self.gauss, MIDDLES)

    def deformation(self, displacement: FloatArray) -> Deformation:
        """Deformation at the cells' middles of nodal displacements (N, 2)."""
        u = displacement[self.mesh.elements].transpose(2, 0, 1).reshape(18, -1)
        return Deformation(AXISYMMETRIC, self._middles.gradient(u))

    def fields(self, displacement: FloatArray, pressure: FloatArray) -> Fields:
        """Fields of nodal displacements (N, 2) and pressure coefficients (3, E)."""
        geometry, deformation = self._middles, self.deformation(displacement)
        mean_stress = np.einsum("ie,iqe->qe", pressure, geometry.pressure)
        stress, measure, ratio = stresses(self.laws, deformation, mean_stress, self.point_modulus, self.finite)
        nodes, moved = np.zeros((len(displacement), 3)), np.zeros((len(displacement), 3))
        nodes[:, ::2], moved[:, ::2] = self.mesh.nodes, displacement
        return Fields(
            points=nodes,
            cells=self.mesh.elements[QUADS].transpose(2, 0, 1).reshape(-1, 4),
            layer=np.repeat(self.mesh.layer, len(QUADS)),
            displacement=moved,
            cauchy_stress=_per_cell(AXISYMMETRIC.tensor(stress)),
            strain=_per_cell(AXISYMMETRIC.tensor(measure)),
            det_F=_per_cell(ratio),
        )


def stresses(
    laws: ElementLaws, deformation: Deformation, mean_stress: FloatArray, point_modulus: FloatArray, finite: bool
) -> _Measures:
    """Cauchy stress in Pa, strain (components, q, E each) and volume ratio (q, E).

    Parameters
    ----------
    laws
        Laws of the elements.
    deformation
        Deformation at q points of the elements.
    mean_stress
        The pressure field there, (q, E) in Pa.
    point_modulus
        Bulk modulus (E,) in Pa that acts at points.
    finite
        Green-Lagrange strain and the stress of the deformed state; otherwise small strain.
    """
    return (_finite if finite else _linear)(laws, deformation, mean_stress, point_modulus)


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


def _per_cell(values: FloatArray) -> FloatArray:
    """Values (q, E, ...) in the order of the cells, (E q, ...)."""
    return np.swapaxes(values, 0, 1).reshape(-1, *values.shape[2:])


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


class Recovery(Protocol):
    """What evaluates fields."""

    @property
    def laws(self) -> ElementLaws:
        """Laws of the elements."""
        ...

    @property
    def finite(self) -> bool:
        """Whether the kinematics is finite."""
        ...

    def deformation(self, displacement: FloatArray) -> Deformation:
        """Deformation at the points of the fields of nodal displacements (N, components)."""
        ...


AnyRecovery = TypeVar("AnyRecovery", bound=Recovery)


def remembering(recovery: AnyRecovery, time: FloatArray, displacement: FloatArray) -> AnyRecovery:
    """Recovery whose laws remember the steps so far.

    Parameters
    ----------
    recovery
        Recovery of the body at rest; returned as it is where no layer relaxes.
    time
        Times (n,) in s of the steps.
    displacement
        Nodal displacements (n, N, components) in m.
    """
    laws = recovery.laws
    if laws.prony is None:
        return recovery
    memory, before = None, min(0.0, float(time[0]))
    for end, u in zip(time.tolist(), displacement, strict=True):
        deformation = recovery.deformation(u)
        if memory is None:
            memory = Memory.of_rest(laws.prony, deformation.H.shape)
        elastic = laws.second_stress(deformation) if recovery.finite else laws.linear_stress(deformation)
        memory, before = memory.after(end - before, elastic), end
    if memory is None:
        return recovery
    return replace(recovery, laws=laws.relaxing(*memory.ahead(0.0)))  # type: ignore[type-var]
