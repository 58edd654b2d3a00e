"""What the hyperelastic materials have in common besides their law."""

from __future__ import annotations

from abc import ABC, abstractmethod

from fem.errors import FemError
from fem.materials import elastic_constants


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
        return elastic_constants.bulk_modulus(youngs, self.poisson_ratio)

    @property
    def finite_strain(self) -> bool:
        """Objective: valid in finite kinematics."""
        return True

    def _require_stiffness(self, what: str) -> None:
        """Refuse a law that is not stiff at rest, naming the constants it comes from."""
        if not self.shear_modulus > 0.0:
            raise FemError(f"{what} = {self.shear_modulus:g} Pa: the shear modulus at rest must be above 0 Pa")
        youngs = 2.0 * self.shear_modulus * (1.0 + self.poisson_ratio) if self.poisson_ratio > -1.0 else 1.0
        elastic_constants.require_elastic_constants(youngs, self.poisson_ratio)
