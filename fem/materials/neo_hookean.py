"""Nearly incompressible neo-Hookean material.

W = mu/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2 with mu and K from Young's modulus and Poisson's ratio at rest
(Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., chapter 6).
"""

from __future__ import annotations

from dataclasses import dataclass

from fem.arrays import FloatArray
from fem.materials.deformation import Deformation
from fem.materials.invariants import first_curvature, first_gradient
from fem.materials.material import IsochoricLaw, IsotropicSolid


@dataclass(frozen=True)
class NeoHookeanLaw:
    """Isochoric neo-Hookean stress and tangent; the one parameter is the shear modulus in Pa."""

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Isochoric strain energy in J/m3, (*points)."""
        out: FloatArray = 0.5 * parameters[0] * deformation.isochoric_invariant_change
        return out

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """P = mu J^(-2/3) (F - I1/(3 J) cof F), shape (components, *points), in Pa."""
        out = first_gradient(deformation)
        out *= parameters[0]
        return out

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF, packed upper triangle (pairs, *points), in Pa."""
        return first_curvature(deformation, parameters[0])


@dataclass(frozen=True)
class NeoHookean(IsotropicSolid):
    """Neo-Hookean solid from Young's modulus in Pa and Poisson's ratio, both at rest; see `IsotropicSolid`."""

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law."""
        return NeoHookeanLaw()

    @property
    def finite_strain(self) -> bool:
        """Objective: valid in finite kinematics."""
        return True
