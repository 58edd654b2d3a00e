"""Nearly incompressible neo-Hookean material.

W = mu/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2 with mu and K from Young's modulus and Poisson's ratio at rest
(Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., chapter 6).
"""

from __future__ import annotations

from dataclasses import dataclass

from fem.arrays import FloatArray
from fem.deformation import Deformation
from fem.materials import elastic_constants
from fem.materials.law import IsochoricLaw


@dataclass(frozen=True)
class NeoHookeanLaw:
    """Isochoric neo-Hookean stress and tangent; the one parameter is the shear modulus in Pa."""

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """P = mu J^(-2/3) (F - I1/(3 J) cof F), shape (components, *points), in Pa.

        Written with the differences from rest, H - (cof F - I) - (I1/(3 J) - 1) cof F, which do not cancel.
        """
        d = deformation
        share = (d.first_invariant_change - 3.0 * d.volume_change) / (3.0 * d.J)
        out: FloatArray = d.H - d.cofactor_change - share * d.cofactor
        out *= parameters[0] * d.isochoric_factor
        return out

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF, packed upper triangle (pairs, *points), in Pa."""
        d = deformation
        k, m = d.components.pairs
        scale = parameters[0] * d.isochoric_factor
        share = scale * (3.0 + d.first_invariant_change) / (3.0 * d.J)
        # -2/3 s/J (F x C + C x F) + 5/9 s I1/J^2 C x C, written as (a C - b F)_k C_m - b C_k F_m
        b = (2.0 / 3.0) * scale / d.J
        mixed = (5.0 / 3.0) * share / d.J * d.cofactor - b * d.F
        out: FloatArray = mixed[k] * d.cofactor[m]
        out -= (b * d.cofactor)[k] * d.F[m]
        out[d.components.cofactor_pairs] -= share * d.cofactor_derivative
        out[d.components.diagonal] += scale
        return out


@dataclass(frozen=True)
class NeoHookean:
    """Neo-Hookean solid from its constants at rest.

    Attributes
    ----------
    youngs_modulus
        Young's modulus at rest in Pa, above 0.
    poisson_ratio
        Poisson's ratio at rest, above -1 and at most 0.4999.

    Raises
    ------
    FemError
        If a constant is outside its range.
    """

    youngs_modulus: float
    poisson_ratio: float

    def __post_init__(self) -> None:
        elastic_constants.require_elastic_constants(self.youngs_modulus, self.poisson_ratio)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest in Pa."""
        return elastic_constants.shear_modulus(self.youngs_modulus, self.poisson_ratio)

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus in Pa."""
        return elastic_constants.bulk_modulus(self.youngs_modulus, self.poisson_ratio)

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law."""
        return NeoHookeanLaw()

    @property
    def parameters(self) -> tuple[float, ...]:
        """The shear modulus in Pa."""
        return (self.shear_modulus,)

    @property
    def finite_strain(self) -> bool:
        """Objective: valid in finite kinematics."""
        return True
