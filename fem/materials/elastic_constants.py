"""Checked elastic constants, shared by the laws that start from Young's modulus and Poisson's ratio."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fem.checks import require_positive
from fem.errors import FemError

LARGEST_POISSON_RATIO = 0.4999


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
