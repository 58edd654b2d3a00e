"""Gent's material, whose chains have a longest stretch.

W = -mu jm / 2 ln(1 - x / jm), x = J^(-2/3) tr C - 3 < jm (A. N. Gent, Rubber Chemistry and Technology 69 (1996) 59).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.errors import require_positive
from fem.materials.invariants import FirstInvariantLaw
from fem.materials.material import Hyperelastic, IsochoricLaw


@dataclass(frozen=True)
class GentLaw(FirstInvariantLaw):
    """Parameters mu in Pa and jm; no answer (NaN) from x = jm on."""

    def energy_of(self, x: FloatArray, parameters: FloatArray) -> FloatArray:
        """W in J/m3, (*points)."""
        mu, jm = parameters
        out: FloatArray = -0.5 * mu * jm * np.log1p(-_within(x, jm) / jm)
        return out

    def slopes(self, x: FloatArray, parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        """2 W' and 4 W'' in Pa, (*points) each."""
        mu, jm = parameters
        slope: FloatArray = mu * jm / (jm - _within(x, jm))
        return slope, 2.0 * slope * slope / (mu * jm)


@dataclass(frozen=True)
class Gent(Hyperelastic):
    """Gent's solid.

    Attributes
    ----------
    mu
        Shear modulus at rest in Pa, above 0.
    jm
        Value of tr C - 3 at which it locks, above 0.
    poisson_ratio
        At rest, above -1 and at most 0.4999.

    Raises
    ------
    FemError
        If a constant is outside its range.
    """

    mu: float
    jm: float
    poisson_ratio: float

    def __post_init__(self) -> None:
        require_positive("gent: mu", self.mu, "Pa")
        require_positive("gent: jm", self.jm, "(no unit)")
        self._require_stiffness("gent: mu")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest in Pa."""
        return self.mu

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law."""
        return GentLaw()

    @property
    def parameters(self) -> tuple[float, ...]:
        """Shear modulus mu in Pa and jm."""
        return self.mu, self.jm


def _within(x: FloatArray, jm: FloatArray) -> FloatArray:
    return np.where(x < jm, x, np.nan)
