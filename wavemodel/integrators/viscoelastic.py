"""Viscoelastic material: relaxation by a Prony series, and damping proportional to mass and stiffness."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError, require_not_negative, require_positive


@dataclass(frozen=True)
class Prony:
    """Relaxation of shear and bulk modulus alike: G(t) / G(0) = 1 - sum_j g_j (1 - e^(-t / tau_j)).

    The moduli of a material are its initial ones, G(0); after a long time 1 - sum g_j of them is left. Poisson's ratio
    stays. Source: Simo and Hughes, Computational Inelasticity, chapter 10 (generalised Maxwell solid).

    Attributes
    ----------
    strength
        (J,) g_j, each above 0, together below 1.
    time
        (J,) tau_j in s, above 0, no two alike.

    Raises
    ------
    WaveError
        If a value is outside its range or the two differ in number.
    """

    strength: tuple[float, ...] = ()
    time: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "strength", tuple(map(float, self.strength)))
        object.__setattr__(self, "time", tuple(map(float, self.time)))
        if len(self.strength) != len(self.time):
            raise WaveError(
                f"relaxation: {len(self.strength)} strengths, {len(self.time)} times: as many of each are needed"
            )
        for name, values, unit in (("strength", self.strength, ""), ("time", self.time, "s")):
            for index, value in enumerate(values):
                require_positive(f"relaxation {name}[{index}]", value, unit)
        if sum(self.strength) >= 1.0:
            raise WaveError(
                f"relaxation strength = {self.strength} is not allowed: together below 1, or nothing is left in the end"
            )
        if len(set(self.time)) < len(self.time):
            raise WaveError(f"relaxation time = {self.time} s is not allowed: no two terms with the same time")

    @property
    def long_term(self) -> float:
        """What is left of the modulus in the end."""
        return 1.0 - sum(self.strength)

    @cached_property
    def ordered(self) -> tuple[FloatArray, FloatArray]:
        """(J,) strengths and (J,) rates 1 / tau_j in 1/s, rates rising."""
        rate = 1.0 / np.array(self.time, dtype=np.float64)
        order = np.argsort(rate)
        return np.array(self.strength, dtype=np.float64)[order], rate[order]

    def modulus(self, time: FloatArray) -> FloatArray:
        """(n,) G(t) / G(0) at times (n,), s."""
        strength, rate = self.ordered
        out: FloatArray = 1.0 + np.expm1(-np.multiply.outer(np.asarray(time), rate)) @ strength
        return out


ELASTIC = Prony()
"""An elastic material."""


@dataclass(frozen=True)
class Damping:
    """C = mass_rate M + stiffness_time K: M q'' + C q' + K q = f.

    Attributes
    ----------
    mass_rate
        In 1/s (Rayleigh's first term).
    stiffness_time
        In s; alone it makes every layer a Kelvin-Voigt solid of this retardation time.

    Raises
    ------
    WaveError
        If one is negative or not finite.
    """

    mass_rate: float = 0.0
    stiffness_time: float = 0.0

    def __post_init__(self) -> None:
        require_not_negative("damping mass_rate", self.mass_rate, "1/s")
        require_not_negative("damping stiffness_time", self.stiffness_time, "s")

    def drag(self, frequency: FloatArray) -> FloatArray:
        """Rates c (N,) in 1/s of q'' + c q' + w^2 q = f for natural frequencies w (N,) in rad/s."""
        return np.asarray(self.mass_rate + self.stiffness_time * frequency**2)
