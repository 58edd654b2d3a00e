"""Neo-Hookean materials: nearly incompressible, and coupled as other codes have it.

W = mu/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2 with mu and K from Young's modulus and Poisson's ratio at rest
(Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., chapter 6). The coupled one,
W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2 (the same, section 6.4.3), is there for comparison with codes that
have no other: its volume change is part of the law, not of the element's pressure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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


@dataclass(frozen=True)
class CoupledNeoHookeanLaw:
    """The whole stress and tangent; parameters are the two Lame constants mu and lambda in Pa."""

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Strain energy in J/m3, (*points)."""
        mu, lame = parameters
        log = np.log1p(deformation.volume_change)
        out: FloatArray = 0.5 * mu * deformation.first_invariant_change + (0.5 * lame * log - mu) * log
        return out

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """P = mu F + (lambda ln J - mu) cof F / J, shape (components, *points), in Pa."""
        mu, lame = parameters
        d = deformation
        share = (lame * np.log1p(d.volume_change) + mu * d.volume_change) / d.J  # mu (1 - 1/J) stands with it
        out: FloatArray = mu * (d.H - d.cofactor_change) + share * d.cofactor
        return out

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF, packed upper triangle (pairs, *points), in Pa."""
        (mu, lame), d = parameters, deformation
        slope = (lame * np.log1p(d.volume_change) - mu) / d.J
        out = np.zeros((len(d.components.pairs[0]), *d.J.shape))
        out[d.components.diagonal] = mu
        out[d.components.cofactor_pairs] += slope * d.cofactor_derivative
        d.components.add_products(out, (lame / d.J - slope) / d.J * d.cofactor, d.cofactor)
        return out


@dataclass(frozen=True)
class CoupledNeoHookean(IsotropicSolid):
    """Coupled neo-Hookean solid from Young's modulus in Pa and Poisson's ratio, both at rest."""

    @property
    def law(self) -> IsochoricLaw:
        """The whole law: nothing is left to the element's pressure."""
        return CoupledNeoHookeanLaw()

    @property
    def parameters(self) -> tuple[float, ...]:
        """Both Lame constants in Pa."""
        nu = self.poisson_ratio
        return self.shear_modulus, self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))

    @property
    def bulk_modulus(self) -> float:
        """None of the element's: the law has its own."""
        return 0.0

    @property
    def finite_strain(self) -> bool:
        """Objective: valid in finite kinematics."""
        return True
