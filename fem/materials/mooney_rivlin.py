"""Mooney and Rivlin's material.

W = c10 (J^(-2/3) I1 - 3) + c01 (J^(-4/3) I2 - 3) (M. Mooney, J. Appl. Phys. 11 (1940) 582; R. S. Rivlin, Phil. Trans.
R. Soc. A 241 (1948) 379).
"""

from __future__ import annotations

from dataclasses import dataclass

from fem.arrays import FloatArray
from fem.errors import require_finite
from fem.materials import invariants
from fem.materials.deformation import Deformation
from fem.materials.material import Hyperelastic, IsochoricLaw


@dataclass(frozen=True)
class MooneyRivlinLaw:
    """Parameters c10 and c01 in Pa."""

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Isochoric strain energy in J/m3, (*points)."""
        c10, c01 = parameters
        second = invariants.second_isochoric_change(deformation)
        out: FloatArray = c10 * deformation.isochoric_invariant_change + c01 * second
        return out

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """First Piola-Kirchhoff stress in Pa, (components, *points)."""
        c10, c01 = 2.0 * parameters
        out: FloatArray = c10 * invariants.first_gradient(deformation)
        out += c01 * invariants.second_gradient(deformation)
        return out

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF, packed upper triangle (pairs, *points), in Pa."""
        c10, c01 = 2.0 * parameters
        out = invariants.first_curvature(deformation, c10)
        out += invariants.second_curvature(deformation, c01)
        return out


@dataclass(frozen=True)
class MooneyRivlin(Hyperelastic):
    """Mooney-Rivlin solid.

    Attributes
    ----------
    c10, c01
        In Pa, their sum above 0: half the shear modulus at rest.
    poisson_ratio
        At rest, above -1 and at most 0.4999.

    Raises
    ------
    FemError
        If a constant is outside its range.
    """

    c10: float
    c01: float
    poisson_ratio: float

    def __post_init__(self) -> None:
        require_finite("mooney_rivlin: c10", self.c10, "Pa")
        require_finite("mooney_rivlin: c01", self.c01, "Pa")
        self._require_stiffness(f"mooney_rivlin: c10 = {self.c10:g} Pa, c01 = {self.c01:g} Pa, 2 (c10 + c01)")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest 2 (c10 + c01) in Pa."""
        return 2.0 * (self.c10 + self.c01)

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law."""
        return MooneyRivlinLaw()

    @property
    def parameters(self) -> tuple[float, ...]:
        """c10 and c01 in Pa."""
        return self.c10, self.c01
