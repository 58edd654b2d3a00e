"""Nearly incompressible neo-Hookean material.

W = mu/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2 with mu and K from Young's modulus and Poisson's ratio at rest
(Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., chapter 6).
"""

from __future__ import annotations

from dataclasses import dataclass

from fem.arrays import FloatArray
from fem.deformation import Deformation
from fem.materials import elastic_constants
from fem.materials.invariants import first_curvature, first_gradient
from fem.materials.law import IsochoricLaw


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
