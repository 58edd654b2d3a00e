"""What a material law is to the solver, and what the materials share.

A law gives the isochoric (shape-changing) part of the stress and its tangent. The volumetric part is the
same for all laws, U(J) = K/2 (J - 1)^2 with the pressure as a field of its own, and belongs to the element.

Elastic constants are checked for the valid range of the mixed element.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Protocol

from fem.arrays import FloatArray
from fem.errors import FemError, require_positive
from fem.materials.deformation import Deformation

LARGEST_POISSON_RATIO = 0.4999


class IsochoricLaw(Protocol):
    """Isochoric energy with its stress and tangent for many points at once; parameters are (k, *broadcast)."""

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Isochoric strain energy in J/m3, (*points)."""
        ...

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """First Piola-Kirchhoff stress in Pa, shape (components, *points); parameters (k, *broadcast)."""
        ...

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF in Pa, packed upper triangle, shape (pairs, *points)."""
        ...


class Material(Protocol):
    """One layer's material."""

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest in Pa."""
        ...

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus in Pa."""
        ...

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law; equal for materials that differ in their parameters only."""
        ...

    @property
    def parameters(self) -> tuple[float, ...]:
        """Parameters the law is evaluated with."""
        ...

    @property
    def finite_strain(self) -> bool:
        """Whether the law is objective, so that it may be used in finite kinematics."""
        ...


def require_elastic_constants(youngs_modulus: float, poisson_ratio: float) -> None:
    """Refuse constants outside the valid range of the mixed element.

    Parameters
    ----------
    youngs_modulus
        Young's modulus in Pa, above 0.
    poisson_ratio
        Poisson's ratio, above -1 and at most 0.4999.

    Raises
    ------
    FemError
        If one of them is outside its range.
    """
    require_positive("youngs_modulus", youngs_modulus, "Pa")
    if not math.isfinite(poisson_ratio) or not -1.0 < poisson_ratio <= LARGEST_POISSON_RATIO:
        raise FemError(
            f"poisson_ratio = {poisson_ratio:g}: must be above -1 and at most {LARGEST_POISSON_RATIO} "
            "(an incompressible material, 0.5, has no bulk modulus)"
        )


def shear_modulus(youngs_modulus: float, poisson_ratio: float) -> float:
    """Shear modulus E / (2 (1 + nu)) in Pa."""
    return youngs_modulus / (2.0 * (1.0 + poisson_ratio))


def bulk_modulus(youngs_modulus: float, poisson_ratio: float) -> float:
    """Bulk modulus E / (3 (1 - 2 nu)) in Pa."""
    return youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio))


@dataclass(frozen=True)
class IsotropicSolid:
    """What laws of two elastic constants share.

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
        require_elastic_constants(self.youngs_modulus, self.poisson_ratio)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest in Pa."""
        return shear_modulus(self.youngs_modulus, self.poisson_ratio)

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus in Pa."""
        return bulk_modulus(self.youngs_modulus, self.poisson_ratio)

    @property
    def parameters(self) -> tuple[float, ...]:
        """The shear modulus in Pa."""
        return (self.shear_modulus,)


class Hyperelastic(ABC):
    """Isochoric law with the volumetric part K/2 (J - 1)^2, K from the law's stiffness at rest and `poisson_ratio`."""

    poisson_ratio: float

    @property
    @abstractmethod
    def shear_modulus(self) -> float:
        """Shear modulus at rest in Pa."""

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus 2 mu (1 + nu) / (3 (1 - 2 nu)) in Pa."""
        youngs = 2.0 * self.shear_modulus * (1.0 + self.poisson_ratio)
        return bulk_modulus(youngs, self.poisson_ratio)

    @property
    def finite_strain(self) -> bool:
        """Objective: valid in finite kinematics."""
        return True

    def _require_stiffness(self, what: str) -> None:
        """Refuse a law that is not stiff at rest, naming the constants it comes from."""
        if not self.shear_modulus > 0.0:
            raise FemError(f"{what} = {self.shear_modulus:g} Pa: the shear modulus at rest must be above 0 Pa")
        youngs = 2.0 * self.shear_modulus * (1.0 + self.poisson_ratio) if self.poisson_ratio > -1.0 else 1.0
        require_elastic_constants(youngs, self.poisson_ratio)
