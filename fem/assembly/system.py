"""The discrete equations: residual and tangent of displacement and pressure, the pressure condensed.

The shapes in the docstrings are those of the axisymmetric element (18 displacements, 3 pressures); other
elements have others. An element without pressure shapes has all of its bulk modulus at the Gauss points.

Two-field form (perturbed Lagrangian): W_iso(F) + p (J - 1) - p^2 / (2 K), u quadratic, p discontinuous, as a rule
linear (Q2/P1, inf-sup stable: Boffi, Brezzi and Fortin, Mixed Finite Element Methods and Applications,
chapter 8). The pressure shapes are orthonormal on each element, so that condensing it adds
K sum_i b_i b_i^T to the element's stiffness, b_i the integral of pressure shape i times dJ/du.
Linear kinematics is the tangent at rest.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass, replace

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.assembly.element_geometry import ELEMENTS_AT_ONCE, ElementGeometry
from fem.assembly.scatter import Numbering, Scatter, packed_positions
from fem.interactions.clamp import Sliding
from fem.interactions.interface import Grip, Slipping
from fem.materials.deformation import Deformation
from fem.materials.element_laws import ElementLaws
from fem.materials.prony import Memory


@dataclass(frozen=True)
class Evaluation:
    """The equations at one state.

    Attributes
    ----------
    deformation
        Deformation gradient at the Gauss points.
    pressure
        Pressure coefficients (3, E) the evaluation was made with.
    pressure_at_points
        Pressure (q, E) in Pa.
    coupling
        b (18, 3, E): derivative of the volume change by the nodal displacements.
    mismatch
        K (volume change) - p (3, E): how far the pressure is from what the volume change asks for.
    element_force
        Nodal forces (18, E) in N with the pressure the volume change asks for.
    residual
        Their sum on the unknowns (n,), with the friction.
    friction_stiffness
        Derivative (m,) in N/m of the friction on the unknowns that rub.
    grips
        The interfaces that slip.
    """

    deformation: Deformation
    pressure: FloatArray
    pressure_at_points: FloatArray
    coupling: FloatArray
    mismatch: FloatArray
    element_force: FloatArray
    residual: FloatArray
    friction_stiffness: FloatArray
    grips: tuple[Grip, ...]

    @property
    def consistent_pressure(self) -> FloatArray:
        """Pressure coefficients (3, E) the volume change asks for."""
        out: FloatArray = self.pressure + self.mismatch
        return out


class System:
    """Residual and tangent of a mesh with laws and a numbering.

    Parameters
    ----------
    geometry
        Geometry at the Gauss points.
    laws
        Laws of the elements.
    numbering, scatter
        Unknowns and the sums into them.
    stabilisation
        Part of the bulk modulus, in shear moduli (at most half of it), that acts on J at each Gauss point
        instead of on the pressure field. It takes nothing from the continuum's energy, but Q2/P1 controls only
        three moments of J on an element, and at large strain the rest can become unstable (Pantuso and
        Bathe, Finite Elements in Analysis and Design 28 (1997) 83).
    """

    def __init__(
        self,
        geometry: ElementGeometry,
        laws: ElementLaws,
        numbering: Numbering,
        scatter: Scatter,
        stabilisation: float = 0.0,
    ) -> None:
        self.geometry = geometry
        self.laws = laws
        self.numbering = numbering
        self.scatter = scatter
        count, components = scatter.element_unknowns.shape[0], len(geometry.tables)
        self._rows, self._columns = packed_positions(count // components, components)
        at_points = np.minimum(stabilisation * laws.shear_modulus, 0.5 * laws.bulk_modulus)
        if len(geometry.pressure) == 0:
            at_points = laws.bulk_modulus
        self.point_modulus = at_points
        self._field_modulus = laws.bulk_modulus - at_points
        self._prescribed: FloatArray | None = None
        shape = (len(geometry.components.positions), *geometry.weight.shape)
        self.memory = None if laws.prony is None else Memory.of_rest(laws.prony, shape)
        self._duration = 0.0
        self.sliding: Sliding | None = None
        self.interfaces: tuple[Slipping, ...] = ()

    @property
    def remembers(self) -> bool:
        """Whether a state depends on the states before it."""
        rubs = self.sliding is not None or any(interface.rubs for interface in self.interfaces)
        return rubs or self.memory is not None

    def advanced(self, duration: float) -> System:
        """The equations of a step that takes `duration` s from the last accepted state."""
        if self.memory is None:
            return self
        other = copy.copy(self)
        other._duration, other.laws = duration, self.laws.relaxing(*self.memory.ahead(duration))
        return other

    def accepted(self, y: FloatArray) -> System:
        """The equations after a step that ends at unknowns y (n,); evaluated there they give its forces."""
        slid = self if self.sliding is None else self.rubbing(self.sliding.after(y))
        if self.interfaces:
            slid = slid.slipping(tuple(interface.after(y) for interface in self.interfaces))
        if self.memory is None:
            return slid
        deformation = Deformation(self.geometry.components, self.geometry.gradient(self.element_displacement(y)))
        other = copy.copy(slid)
        other.memory = self.memory.after(self._duration, self.laws.second_stress(deformation))
        return other.advanced(0.0)

    def corrected(self, y: FloatArray, press: float) -> System | None:
        """The equations that fit a state with unknowns y (n,) and a press in N; None if these do."""
        del y, press
        return None

    def lightened(self, share: float) -> System | None:
        """The equations to begin with where a share of the press is left; None if they are these."""
        del share
        return None

    def with_laws(self, laws: ElementLaws) -> System:
        """The same equations with other laws of the same moduli at rest."""
        other = copy.copy(self)
        other.laws = laws
        return other

    def rubbing(self, sliding: Sliding) -> System:
        """The same equations with friction on a fixed body."""
        other = copy.copy(self)
        other.sliding = sliding
        return other

    def slipping(self, interfaces: tuple[Slipping, ...]) -> System:
        """The same equations with interfaces that slip, whose entries the pattern has."""
        other = copy.copy(self)
        other.interfaces = interfaces
        return other

    def displaced(self, elements: IntArray, prescribed: FloatArray) -> System:
        """The same equations with displacements (components, N) in m on top of the unknowns', elements (nodes, E)."""
        other = copy.copy(self)
        other.numbering = replace(self.numbering, prescribed=prescribed)
        other._prescribed = np.concatenate([u[elements] for u in prescribed])
        return other

    @property
    def is_displaced(self) -> bool:
        """Whether there are prescribed displacements."""
        return self._prescribed is not None

    @property
    def plain(self) -> System:
        """The same equations without prescribed displacements and without friction on a fixed body."""
        if self._prescribed is None and self.sliding is None:
            return self
        other = copy.copy(self)
        other.sliding = None
        other.numbering, other._prescribed = replace(self.numbering, prescribed=None), None
        return other

    def scaled(self, share: float) -> System:
        """The same equations with a share of the prescribed displacements."""
        nodal, element = self.numbering.prescribed, self._prescribed
        if nodal is None or element is None:
            return self
        other = copy.copy(self)
        other.numbering, other._prescribed = replace(self.numbering, prescribed=share * nodal), share * element
        return other

    def element_displacement(self, y: FloatArray) -> FloatArray:
        """Nodal displacements of each element (18, E) in m at the unknowns y (n,)."""
        u = self.scatter.gather(y)
        return u if self._prescribed is None else u + self._prescribed

    def rest(self) -> tuple[FloatArray, FloatArray]:
        """Unknowns (n,) and pressure coefficients (3, E) at rest."""
        return np.zeros(self.numbering.count), np.zeros((len(self.geometry.pressure), len(self.laws.bulk_modulus)))

    def evaluate(self, y: FloatArray, pressure: FloatArray) -> Evaluation | None:
        """Equations at unknowns y (n,) and pressure coefficients (3, E).

        Returns
        -------
        Evaluation or None
            None where an element is turned inside out (J <= 0) or a value is not finite.
        """
        deformation = Deformation(self.geometry.components, self.geometry.gradient(self.element_displacement(y)))
        if not deformation.J.min() > 0.0:
            return None
        shapes, weight, bulk = self.geometry.pressure, self.geometry.weight, self._field_modulus
        change = deformation.volume_change
        at_points = np.einsum("ie,iqe->qe", pressure, shapes) + self.point_modulus * change
        volume_change = np.einsum("iqe,qe->ie", shapes, weight * change)
        mismatch = bulk * volume_change - pressure
        coupling = self.geometry.coupling(deformation.cofactor * weight)
        stress = self.laws.stress(deformation) + at_points * deformation.cofactor
        force = self.geometry.forces(stress * weight) + np.einsum("nie,ie->ne", coupling, mismatch)
        residual, friction_stiffness = self._with_friction(self.scatter.vector(force), y)
        grips = self._gripped(residual, y)
        if grips is None or not np.isfinite(residual).all():
            return None
        return Evaluation(
            deformation, pressure, at_points, coupling, mismatch, force, residual, friction_stiffness, grips
        )

    def _gripped(self, residual: FloatArray, y: FloatArray) -> tuple[Grip, ...] | None:
        """The interfaces at unknowns y (n,), their forces added to the residual (n,); None beyond an end of one."""
        grips = []
        for interface in self.interfaces:
            grip = interface.grip(y)
            if grip is None:
                return None
            interface.add_force(grip, residual)
            grips.append(grip)
        return tuple(grips)

    def _with_friction(self, residual: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces (n,) with the friction at unknowns y (n,), and the friction's derivative (m,)."""
        if self.sliding is None:
            return residual, np.zeros(0)
        residual[self.sliding.unknowns] += self.sliding.force(y)
        return residual, self.sliding.stiffness(y)

    def tangent(self, state: Evaluation) -> FloatArray:
        """Upper triangle (nnz,) of the tangent, the pressure condensed."""
        components = self.geometry.components
        moduli = self.laws.tangent(state.deformation)
        moduli[components.cofactor_pairs] += state.pressure_at_points * state.deformation.cofactor_derivative
        cofactor = state.deformation.cofactor
        components.add_products(moduli, self.point_modulus * cofactor, cofactor)
        moduli *= self.geometry.weight
        packed = self.geometry.stiffness(moduli)
        self._condense(packed, state.coupling)
        out = self.scatter.matrix(packed)
        if self.sliding is not None:
            out[self.scatter.indptr[self.sliding.unknowns]] += state.friction_stiffness
        for interface, grip in zip(self.interfaces, state.grips, strict=True):
            out[self.scatter.places(*interface.entries)] += interface.values(grip)
        return out

    def _condense(self, packed: FloatArray, coupling: FloatArray) -> None:
        """Add what the eliminated pressure does to the packed stiffness."""
        for start in range(0, packed.shape[1], ELEMENTS_AT_ONCE):
            part = slice(start, start + ELEMENTS_AT_ONCE)
            b, bulk = coupling[..., part], self._field_modulus[part]
            packed[:, part] += np.einsum("pie,pie->pe", (b * bulk)[self._rows], b[self._columns])

    def pressure_after(self, state: Evaluation, dy: FloatArray) -> FloatArray:
        """Pressure coefficients (3, E) after a Newton increment dy (n,) of the unknowns."""
        change = np.einsum("nie,ne->ie", state.coupling, self.scatter.gather(dy))
        out: FloatArray = state.pressure + state.mismatch + self._field_modulus * change
        return out

    def linear_pressure(self, rest: Evaluation, y: FloatArray) -> FloatArray:
        """Pressure coefficients (3, E) at small displacements y (n,)."""
        out: FloatArray = self._field_modulus * np.einsum("nie,ne->ie", rest.coupling, self.element_displacement(y))
        return out

    def linear_residual(self, rest: Evaluation, y: FloatArray) -> FloatArray:
        """Forces (n,) of small displacements y (n,), from the moduli and the interfaces at rest."""
        out = self.scatter.vector(self.linear_force(rest, y))
        for interface, grip in zip(self.interfaces, rest.grips, strict=True):
            (rows, columns), values = interface.entries, interface.values(grip)
            mirrored = np.where(rows == columns, 0.0, values)
            np.add.at(out, rows, values * y[columns])
            np.add.at(out, columns, mirrored * y[rows])
        return out

    def linear_force(self, rest: Evaluation, y: FloatArray) -> FloatArray:
        """Nodal forces (18, E) in N of small displacements y (n,), from the moduli at rest."""
        u = self.element_displacement(y)
        H, components = self.geometry.gradient(u), self.geometry.components
        moduli = components.unpack(self.laws.tangent(rest.deformation))
        stress = np.einsum("kmqe,mqe->kqe", moduli, H)
        stress[components.normal] += self.point_modulus * H[components.normal].sum(axis=0)
        pressure = self.linear_pressure(rest, y)
        out: FloatArray = self.geometry.forces(stress * self.geometry.weight) + np.einsum(
            "nie,ie->ne", rest.coupling, pressure
        )
        return out
