"""The discrete equations: residual and tangent of displacement and pressure, the pressure condensed.

Two-field form (perturbed Lagrangian): W_iso(F) + p (J - 1) - p^2 / (2 K), u biquadratic, p linear and
discontinuous (Q2/P1, inf-sup stable: Boffi, Brezzi and Fortin, Mixed Finite Element Methods and Applications,
chapter 8). The pressure shapes are orthonormal on each element, so that condensing it adds
K sum_i b_i b_i^T to the element's stiffness, b_i the integral of pressure shape i times dJ/du.
Linear kinematics is the tangent at rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.assembly.geometry import Geometry
from fem.assembly.laws import ElementLaws
from fem.assembly.scatter import Numbering, Scatter, packed_positions
from fem.assembly.shapes import stiffness_tables
from fem.components import AXISYMMETRIC
from fem.deformation import Deformation


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
        Their sum on the unknowns (n,).
    """

    deformation: Deformation
    pressure: FloatArray
    pressure_at_points: FloatArray
    coupling: FloatArray
    mismatch: FloatArray
    element_force: FloatArray
    residual: FloatArray

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
        Bathe, Int. J. Numer. Meth. Engng 40 (1997) 2051).
    """

    def __init__(
        self,
        geometry: Geometry,
        laws: ElementLaws,
        numbering: Numbering,
        scatter: Scatter,
        stabilisation: float = 0.0,
    ) -> None:
        self.geometry = geometry
        self.laws = laws
        self.numbering = numbering
        self.scatter = scatter
        self._tables = stiffness_tables(geometry.shapes)
        self._rows, self._columns = packed_positions()
        at_points = np.minimum(stabilisation * laws.shear_modulus, 0.5 * laws.bulk_modulus)
        self.point_modulus = at_points
        self._field_modulus = laws.bulk_modulus - at_points

    def rest(self) -> tuple[FloatArray, FloatArray]:
        """Unknowns (n,) and pressure coefficients (3, E) at rest."""
        return np.zeros(self.numbering.count), np.zeros((3, len(self.laws.bulk_modulus)))

    def evaluate(self, y: FloatArray, pressure: FloatArray) -> Evaluation | None:
        """Equations at unknowns y (n,) and pressure coefficients (3, E).

        Returns
        -------
        Evaluation or None
            None where an element is turned inside out (J <= 0) or a value is not finite.
        """
        deformation = Deformation(AXISYMMETRIC, self.geometry.gradient(self.scatter.gather(y)))
        if not deformation.J.min() > 0.0:
            return None
        shapes, weight, bulk = self.geometry.pressure, self.geometry.weight, self._field_modulus
        change = deformation.volume_change
        at_points = np.einsum("ie,iqe->qe", pressure, shapes) + self.point_modulus * change
        volume_change = np.einsum("iqe,qe->ie", shapes, weight * change)
        mismatch = bulk * volume_change - pressure
        coupling = self._coupling(deformation)
        stress = self.laws.stress(deformation) + at_points * deformation.cofactor
        force = self._forces(stress) + np.einsum("nie,ie->ne", coupling, mismatch)
        residual = self.scatter.vector(force)
        return Evaluation(deformation, pressure, at_points, coupling, mismatch, force, residual)

    def tangent(self, state: Evaluation) -> FloatArray:
        """Upper triangle (nnz,) of the tangent, the pressure condensed."""
        moduli = self.laws.tangent(state.deformation)
        moduli[AXISYMMETRIC.cofactor_pairs] += state.pressure_at_points * state.deformation.cofactor_derivative
        k, m = AXISYMMETRIC.pairs
        cofactor = state.deformation.cofactor
        moduli += (self.point_modulus * cofactor)[k] * cofactor[m]
        half = self.geometry.pull_back(AXISYMMETRIC.unpack(moduli * self.geometry.weight))
        rows = self.geometry.pull_back(np.swapaxes(half, 0, 1))[k, m]
        flat = rows.reshape(-1, rows.shape[2])
        q = self.geometry.shapes.count
        rr, rz, zz = self._tables
        packed = np.concatenate((rr @ flat[: 6 * q], rz @ flat[6 * q : 12 * q], zz @ flat[12 * q :]))
        b, bulk = state.coupling, self._field_modulus
        packed += np.einsum("pie,pie->pe", (b * bulk)[self._rows], b[self._columns])
        return self.scatter.matrix(packed)

    def pressure_after(self, state: Evaluation, dy: FloatArray) -> FloatArray:
        """Pressure coefficients (3, E) after a Newton increment dy (n,) of the unknowns."""
        change = np.einsum("nie,ne->ie", state.coupling, self.scatter.gather(dy))
        out: FloatArray = state.pressure + state.mismatch + self._field_modulus * change
        return out

    def linear_force(self, rest: Evaluation, y: FloatArray) -> FloatArray:
        """Nodal forces (18, E) in N of small displacements y (n,), from the moduli at rest."""
        u = self.scatter.gather(y)
        H = self.geometry.gradient(u)
        moduli = AXISYMMETRIC.unpack(self.laws.tangent(rest.deformation))
        stress = np.einsum("kmqe,mqe->kqe", moduli, H)
        stress[AXISYMMETRIC.normal] += self.point_modulus * H[AXISYMMETRIC.normal].sum(axis=0)
        pressure = self._field_modulus * np.einsum("nie,ne->ie", rest.coupling, u)
        out: FloatArray = self._forces(stress) + np.einsum("nie,ie->ne", rest.coupling, pressure)
        return out

    def _forces(self, stress: FloatArray) -> FloatArray:
        flat = self.geometry.pull_back(stress * self.geometry.weight).reshape(-1, stress.shape[2])
        split = 3 * self.geometry.shapes.count
        radial, vertical = self.geometry.shapes.radial, self.geometry.shapes.vertical
        return np.concatenate((radial.T @ flat[:split], vertical.T @ flat[split:]))

    def _coupling(self, deformation: Deformation) -> FloatArray:
        """Coupling b (18, 3, E)."""
        q, count = deformation.J.shape
        rate = self.geometry.pull_back(deformation.cofactor * self.geometry.weight)
        weighted = (rate[:, :, None, :] * self.geometry.pressure.transpose(1, 0, 2)).reshape(5 * q, 3 * count)
        radial, vertical = self.geometry.shapes.radial, self.geometry.shapes.vertical
        both = np.concatenate((radial.T @ weighted[: 3 * q], vertical.T @ weighted[3 * q :]))
        return both.reshape(18, 3, count)
