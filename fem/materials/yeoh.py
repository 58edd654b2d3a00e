"""Yeoh's material.

W = c10 x + c20 x^2 + c30 x^3, x = J^(-2/3) tr C - 3 (O. H. Yeoh, Rubber Chemistry and Technology 66 (1993) 754).
"""

from __future__ import annotations

from dataclasses import dataclass

from fem.arrays import FloatArray
from fem.errors import require_finite
from fem.materials.invariants import FirstInvariantLaw
from fem.materials.material import Hyperelastic, IsochoricLaw


@dataclass(frozen=True)
class YeohLaw(FirstInvariantLaw):
    """Parameters c10, c20, c30 in Pa."""

    def energy_of(self, x: FloatArray, parameters: FloatArray) -> FloatArray:
        """W in J/m3, (*points)."""
        c10, c20, c30 = parameters
        out: FloatArray = x * (c10 + x * (c20 + x * c30))
        return out

    def slopes(self, x: FloatArray, parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        """2 W' and 4 W'' in Pa, (*points) each."""
        c10, c20, c30 = parameters
        return 2.0 * c10 + x * (4.0 * c20 + 6.0 * x * c30), 8.0 * c20 + 24.0 * x * c30


@dataclass(frozen=True)
class Yeoh(Hyperelastic):
    """Yeoh's solid.

    Attributes
    ----------
    c10
        In Pa, above 0: half the shear modulus at rest.
    c20, c30
        In Pa, any sign; a negative one softens, and the press may find no equilibrium where the law turns over.
    poisson_ratio
        At rest, above -1 and at most 0.4999.

    Raises
    ------
    FemError
        If a constant is outside its range.
    """

    c10: float
    c20: float
    c30: float
    poisson_ratio: float

    def __post_init__(self) -> None:
        for name in ("c10", "c20", "c30"):
            require_finite(f"yeoh: {name}", getattr(self, name), "Pa")
        self._require_stiffness(f"yeoh: c10 = {self.c10:g} Pa, 2 c10")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest 2 c10 in Pa."""
        return 2.0 * self.c10

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law."""
        return YeohLaw()

    @property
    def parameters(self) -> tuple[float, ...]:
        """c10, c20, c30 in Pa."""
        return self.c10, self.c20, self.c30
