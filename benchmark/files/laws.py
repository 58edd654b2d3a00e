"""Hyperelastic laws, relaxation and fibres as a tissue file names them: parameters and bounds, no mechanics.

Each law states its initial shear modulus, so that a file whose law and Young's modulus disagree can be told.
The volumetric part always follows the layer's Poisson ratio.
"""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from benchmark.files.base import FileModel
from benchmark.files.quantities import (
    Angle,
    Bounds,
    Duration,
    Modulus,
    Number,
    Pressure,
    SignedModulus,
    problem,
)


class NeoHookean(FileModel):
    """W = c10 (I1 - 3); without `c10` it follows the layer's moduli."""

    law: Literal["neo_hookean"] = "neo_hookean"
    c10: Modulus | None = None

    @property
    def shear_modulus(self) -> float | None:
        """Initial shear modulus 2 c10 in Pa; None where the layer's moduli give it."""
        return None if self.c10 is None else 2 * self.c10


class MooneyRivlin(FileModel):
    """W = c10 (I1 - 3) + c01 (I2 - 3)."""

    law: Literal["mooney_rivlin"]
    c10: SignedModulus
    c01: SignedModulus

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus 2 (c10 + c01) in Pa."""
        return 2 * (self.c10 + self.c01)

    @model_validator(mode="after")
    def _stiff_at_rest(self) -> Self:
        _require_stiffness(self.shear_modulus)
        return self


class Yeoh(FileModel):
    """W = c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3."""

    law: Literal["yeoh"]
    c10: Modulus
    c20: SignedModulus = 0.0
    c30: SignedModulus = 0.0

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus 2 c10 in Pa."""
        return 2 * self.c10


class OgdenTerm(FileModel):
    """One term mu / alpha (l1^alpha + l2^alpha + l3^alpha - 3) of Ogden's energy."""

    mu: SignedModulus
    alpha: Annotated[float, Number("-1000 to 1000", Bounds(-1e3, 1e3))]


class Ogden(FileModel):
    """W = sum of mu_p / alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3)."""

    law: Literal["ogden"]
    terms: Annotated[tuple[OgdenTerm, ...], Field(min_length=1, max_length=6)]

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus, half the sum of mu_p alpha_p, in Pa."""
        return sum(term.mu * term.alpha for term in self.terms) / 2

    @model_validator(mode="after")
    def _stiff_at_rest(self) -> Self:
        _require_stiffness(self.shear_modulus)
        return self


class Gent(FileModel):
    """W = -mu jm / 2 ln(1 - (I1 - 3) / jm), which locks at I1 = 3 + jm."""

    law: Literal["gent"]
    mu: Modulus
    jm: Annotated[float, Number("above 0, at most 1e6", Bounds(0.0, 1e6, above=True))]

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus mu in Pa."""
        return self.mu


Hyperelastic = Annotated[NeoHookean | MooneyRivlin | Yeoh | Ogden | Gent, Field(discriminator="law")]


class PronyTerm(FileModel):
    """One fading part of the stiffness: the fraction `g` relaxes with the time constant `tau` (s)."""

    g: Annotated[float, Number("above 0 and below 1", Bounds(0.0, 1.0 - 1e-9, above=True))]
    tau: Duration


class Fibre(FileModel):
    """One fibre family of Holzapfel, Gasser and Ogden in the plane of the layer.

    W = k1 / (2 k2) (exp(k2 E^2) - 1), E = dispersion (I1 - 3) + (1 - 3 dispersion) (I4 - 1); `angle` from the x axis.
    Without an angle the fibres spread evenly over the plane, I4 the mean over its directions.
    """

    angle: Angle | None = None
    k1: Pressure
    k2: Annotated[float, Number("above 0, at most 1e4", Bounds(0.0, 1e4, above=True))]
    dispersion: Annotated[float, Number("0 (aligned) to 1/3 (isotropic)", Bounds(0.0, 0.33333333333333337))] = 0.0


def _require_stiffness(shear_modulus: float) -> None:
    if not shear_modulus > 0:
        raise problem(f"the law's initial shear modulus is {shear_modulus:.6g} Pa; it must be above 0 Pa")
