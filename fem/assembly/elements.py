"""The elements of a mesh with their laws: forces and stiffness of displacement and pressure, the pressure condensed.

In shapes an element has k displacements, its nodes times the components, and p pressures (18 and 3 in axial symmetry).
One without pressure shapes has all of its bulk modulus at the Gauss points.

Two-field form (perturbed Lagrangian): W_iso(F) + p (J - 1) - p^2 / (2 K), u quadratic, p discontinuous, as a rule
linear (Q2/P1, inf-sup stable: Boffi, Brezzi and Fortin, Mixed Finite Element Methods and Applications,
chapter 8). The pressure shapes are orthonormal on each element, so that condensing it adds
K sum_i b_i b_i^T to the element's stiffness, b_i the integral of pressure shape i times dJ/du.
Linear kinematics is the tangent at rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fem.arrays import FloatArray
from fem.assembly.element_geometry import ElementGeometry
from fem.materials.deformation import Deformation
from fem.materials.element_laws import ElementLaws
from fem.materials.prony import Memory
from fem.threads import do_in_threads, in_parts, in_threads

ELEMENTS_AT_ONCE = 64  # so that their pulled back moduli stay in the cache
THREADS_FROM = 32  # parts of so many elements; fewer are done before threads have begun


@dataclass(frozen=True)
class ElementState:
    """The elements at one state.

    Attributes
    ----------
    deformation
        Deformation gradient at the Gauss points.
    pressure
        Pressure coefficients (p, E) the evaluation was made with.
    pressure_at_points
        Pressure (q, E) in Pa.
    coupling
        b (k, p, E): derivative of the volume change by the nodal displacements.
    mismatch
        K (volume change) less the pressure, (p, E): how far that is from what the volume change asks for.
    force
        Nodal forces (k, E) in N with the pressure the volume change asks for.
    """

    deformation: Deformation
    pressure: FloatArray
    pressure_at_points: FloatArray
    coupling: FloatArray
    mismatch: FloatArray
    force: FloatArray

    @property
    def consistent_pressure(self) -> FloatArray:
        """Pressure coefficients (p, E) the volume change asks for."""
        out: FloatArray = self.pressure + self.mismatch
        return out


@dataclass(frozen=True)
class Elements:
    """Geometry and laws of all elements, and what the material remembers.

    Attributes
    ----------
    geometry
        Geometry at the Gauss points.
    laws
        Laws of the elements, those of a step of relaxation while one is under way.
    point_modulus
        Part (E,) in Pa of the bulk modulus that acts on J at each Gauss point instead of on the pressure field.
    memory
        Relaxation up to the last accepted state; None where no layer relaxes.
    duration
        Of the step under way, in s.
    """

    geometry: ElementGeometry
    laws: ElementLaws
    point_modulus: FloatArray
    memory: Memory | None = None
    duration: float = 0.0

    @property
    def field_modulus(self) -> FloatArray:
        """Bulk modulus (E,) in Pa that acts on the pressure field."""
        out: FloatArray = self.laws.bulk_modulus - self.point_modulus
        return out

    @property
    def rest_pressure(self) -> FloatArray:
        """Pressure coefficients (p, E) at rest."""
        return np.zeros((len(self.geometry.pressure), len(self.laws.bulk_modulus)))

    def deformation(self, u: FloatArray) -> Deformation:
        """Deformation at the Gauss points of nodal displacements (k, E) in m."""
        return Deformation(self.geometry.components, self.geometry.gradient(u))

    def evaluate(self, u: FloatArray, pressure: FloatArray) -> ElementState | None:
        """Forces at nodal displacements (k, E) and pressure coefficients (p, E); None where J <= 0."""
        deformation = self.deformation(u)
        if not deformation.J.min() > 0.0:
            return None
        shapes, weight = self.geometry.pressure, self.geometry.weight
        change = deformation.volume_change
        at_points = np.einsum("ie,iqe->qe", pressure, shapes) + self.point_modulus * change
        volume_change = np.einsum("iqe,qe->ie", shapes, weight * change)
        mismatch = self.wanted_pressure(volume_change) - pressure
        coupling = self.geometry.coupling(deformation.cofactor * weight)
        stress = self.laws.stress_change(deformation) + at_points * deformation.cofactor
        force = self.geometry.forces(stress * weight) + np.einsum("nie,ie->ne", coupling, mismatch)
        return ElementState(deformation, pressure, at_points, coupling, mismatch, force)

    def wanted_pressure(self, volume_change: FloatArray) -> FloatArray:
        """Pressure coefficients (p, E) that the moments (p, E) of the volume change ask for."""
        out: FloatArray = self.field_modulus * volume_change
        return out

    def pressure_slope(self, state: ElementState) -> FloatArray:  # noqa: ARG002 (another energy's has one)
        """Derivative (E,) in Pa of the wanted pressure by the volume change."""
        return self.field_modulus

    def stiffness_parts(self, state: ElementState) -> Iterator[tuple[slice, FloatArray]]:
        """Elements and their packed stiffness (entries, part) in N/m, the pressure condensed, part by part."""
        moduli, slope = self._moduli(state), self.pressure_slope(state)
        parts = in_parts(len(slope), ELEMENTS_AT_ONCE)
        worked_on = map if len(parts) < THREADS_FROM else in_threads
        yield from zip(parts, worked_on(partial(self._stiffness, moduli, state, slope), parts), strict=True)

    def soft_matrices(self, state: ElementState) -> tuple[FloatArray, FloatArray]:
        """Stiffness (E, k, k) with at most the shear modulus as derivative of the pressure; the rest (E,)."""
        slope, (rows, columns) = self.pressure_slope(state), self.geometry.packed
        soft: FloatArray = np.minimum(slope, self.laws.shear_modulus)
        moduli = self._moduli(state)
        out = np.empty((len(slope), len(state.force), len(state.force)))

        def fill(part: slice) -> None:
            packed = self._stiffness(moduli, state, soft, part)
            out[part, rows, columns] = out[part, columns, rows] = packed.T

        do_in_threads(fill, in_parts(len(slope), ELEMENTS_AT_ONCE))
        return out, slope - soft

    def _moduli(self, state: ElementState) -> FloatArray:
        """Weighted moduli (pairs, q, E) of all but the pressure's shapes."""
        components, deformation = self.geometry.components, state.deformation
        moduli = self.laws.tangent(deformation)
        moduli[components.cofactor_pairs] += state.pressure_at_points * deformation.cofactor_derivative
        components.add_products(moduli, self.point_modulus * deformation.cofactor, deformation.cofactor)
        moduli *= self.geometry.weight
        return moduli

    def _stiffness(self, moduli: FloatArray, state: ElementState, slope: FloatArray, part: slice) -> FloatArray:
        """Packed stiffness (entries, part) of some elements, the pressure with a slope (E,) condensed."""
        packed = self.geometry.stiffness(moduli[..., part], part)
        self._condense(packed, state.coupling[..., part], slope[part])
        return packed

    def _condense(self, packed: FloatArray, coupling: FloatArray, modulus: FloatArray) -> None:
        """Add what the eliminated pressure does to the packed stiffness, with its slope in Pa."""
        if coupling.shape[1] > 0:
            rows, columns = self.geometry.packed
            packed += np.einsum("pie,pie->pe", (coupling * modulus)[rows], coupling[columns])

    def pressure_after(self, state: ElementState, du: FloatArray) -> FloatArray:
        """Pressure coefficients (p, E) after an increment du (k, E) of the nodal displacements."""
        change = np.einsum("nie,ne->ie", state.coupling, du)
        out: FloatArray = state.pressure + state.mismatch + self.pressure_slope(state) * change
        return out

    def linear_pressure(self, rest: ElementState, u: FloatArray) -> FloatArray:
        """Pressure coefficients (p, E) at small nodal displacements (k, E)."""
        out: FloatArray = self.field_modulus * np.einsum("nie,ne->ie", rest.coupling, u)
        return out

    def linear_force(self, rest: ElementState, u: FloatArray) -> FloatArray:
        """Nodal forces (k, E) in N of small nodal displacements (k, E), from the moduli at rest."""
        H, components = self.geometry.gradient(u), self.geometry.components
        moduli = components.unpack(self.laws.tangent(rest.deformation))
        stress = np.einsum("kmqe,mqe->kqe", moduli, H)
        stress[components.normal] += self.point_modulus * H[components.normal].sum(axis=0)
        pressure = self.linear_pressure(rest, u)
        out: FloatArray = self.geometry.forces(stress * self.geometry.weight) + np.einsum(
            "nie,ie->ne", rest.coupling, pressure
        )
        return out

    def advanced(self, duration: float) -> Elements:
        """The elements in a step that takes `duration` s from the last accepted state."""
        if self.memory is None:
            return self
        return replace(self, duration=duration, laws=self.laws.relaxing(*self.memory.ahead(duration)))

    def accepted(self, u: FloatArray) -> Elements:
        """The elements after a step that ends at nodal displacements (k, E); evaluated there they give its forces."""
        if self.memory is None:
            return self
        elastic = self.laws.second_stress(self.deformation(u))
        return replace(self, memory=self.memory.after(self.duration, elastic)).advanced(0.0)


def make_elements(geometry: ElementGeometry, laws: ElementLaws, stabilisation: float = 0.0) -> Elements:
    """Elements at rest.

    Parameters
    ----------
    geometry, laws
        Geometry at the Gauss points and laws.
    stabilisation
        Part of the bulk modulus, in shear moduli, that acts on J at each Gauss point instead of on the pressure
        field: at most half of it, or all of it where the pressure is constant. It takes nothing from the
        continuum's energy, but Q2/P1 controls only three moments of J on an element, and at large strain the rest
        can become unstable (Pantuso and Bathe, Finite Elements in Analysis and Design 28 (1997) 83); a constant
        pressure controls one.
    """
    most = 1.0 if len(geometry.pressure) == 1 else 0.5
    at_points: FloatArray = np.minimum(stabilisation * laws.shear_modulus, most * laws.bulk_modulus)
    if len(geometry.pressure) == 0:
        at_points = laws.bulk_modulus
    shape = (len(geometry.components.positions), *geometry.weight.shape)
    return Elements(geometry, laws, at_points, None if laws.prony is None else Memory.of_rest(laws.prony, shape))
