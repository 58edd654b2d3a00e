"""Options that change the elastic force of a body: stiffening, pretension, a floor, interface slip, softening."""

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from wavemodel.arrays import FloatArray
from wavemodel.errors import require_between
from wavemodel.integrators.scan import bounded_sum
from wavemodel.physics.load_segment import LoadSegment, Memory

LENGTH = 1e-3
"""m, where the stiffness of a floor is told."""
STEEPEST = 50.0
"""Exponent up to which a body stiffens exponentially; beyond, a search has lost its way."""


@dataclass(frozen=True)
class StrainStiffening:
    """F = f(d) (1 + (b_1 x + b_2 x^2) e^(b_3 x^2)), x = |d| / length.

    The first terms of any smooth hyperelastic law; on a bonded base it fits a neo-Hookean body to 0.02 % with the
    height of the stack as the length (Hayes et al. 1972, J Biomech 5:541 for the linear law that is corrected). With
    b_3 it grows as in Fung's exponential law (Y. C. Fung 1967, Am J Physiol 213:1532).

    Attributes
    ----------
    linear, quadratic
        b_1 and b_2, 0 to 1e4; both zero: off.
    length
        In m, 1e-6 to 10.
    exponential
        b_3, 0 to 1e4.
    """

    linear: float = 0.0
    quadratic: float = 0.0
    length: float = 1e-2
    exponential: float = 0.0

    def __post_init__(self) -> None:
        require_between("strain stiffening", "linear", self.linear, "", 0.0, 1e4)
        require_between("strain stiffening", "quadratic", self.quadratic, "", 0.0, 1e4)
        require_between("strain stiffening", "length", self.length, "m", 1e-6, 10.0)
        require_between("strain stiffening", "exponential", self.exponential, "", 0.0, 1e4)

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        return segment.force * self.factor(segment.depth), memory

    def factor(self, depth: FloatArray) -> FloatArray:
        """(n,) force over f at depths (n,), m; exponents end at `STEEPEST`."""
        x = np.abs(depth) / self.length
        steeper = np.exp(np.minimum(self.exponential * x**2, STEEPEST))
        return np.asarray(1.0 + x * (self.linear + self.quadratic * x) * steeper)


@dataclass(frozen=True)
class Pretension:
    """F = f(d) + k d.

    Attributes
    ----------
    stiffness
        k in N/m, 0 to 1e6; zero: off.
    """

    stiffness: float

    def __post_init__(self) -> None:
        require_between("pretension", "stiffness", self.stiffness, "N/m", 0.0, 1e6)

    @classmethod
    def of_membrane(cls, tension: float, tool_radius: float, hole_radius: float) -> "Pretension":
        """A membrane over a round hole under a flat rigid disc, T lap w = -q: k = 2 pi T / ln(R / a).

        Parameters
        ----------
        tension
            T in N/m, 0 to 1e6.
        tool_radius, hole_radius
            a and R in m, 0 < a < R.
        """
        require_between("pretension", "tension", tension, "N/m", 0.0, 1e6)
        require_between("pretension", "tool radius", tool_radius, "m", 0.0, 0.999 * hole_radius, open_low=True)
        return cls(float(2.0 * np.pi * tension / np.log(hole_radius / tool_radius)))

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        return segment.force + np.where(segment.touching, self.stiffness * segment.depth, 0.0), memory


@dataclass(frozen=True)
class Floor:
    """F = f(d) + k l (s / l)^p, s = max(d - d_f, 0), l = 1 mm: contact with a floor that yields elastically.

    A flat floor is Winkler's (p = 1), a domed one is met as in Hertz's contact (p = 3/2).

    Attributes
    ----------
    depth
        d_f in m, 0 to 10.
    stiffness
        k in N/m, 0 to 1e8; zero: off.
    power
        p, 1 to 3.
    """

    depth: float
    stiffness: float
    power: float = 1.0

    def __post_init__(self) -> None:
        require_between("floor", "depth", self.depth, "m", 0.0, 10.0)
        require_between("floor", "stiffness", self.stiffness, "N/m", 0.0, 1e8)
        require_between("floor", "power", self.power, "", 1.0, 3.0)

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        beyond = np.maximum(segment.depth - self.depth, 0.0) / LENGTH
        return segment.force + self.stiffness * LENGTH * beyond**self.power, memory


@dataclass(frozen=True)
class InterfaceSlip:
    """F = (1 - s) f + y, where y follows s f but stays within -s F_s and +s F_s.

    A Jenkin element (spring and Coulomb slider in series) beside the rest of the body; on reversal it sticks until it
    has been pulled twice the limit back (W. D. Iwan 1966, J Appl Mech 33:893). It does not depend on rate.

    Attributes
    ----------
    limit
        F_s in N, above 0: the force at which the interface begins to slide.
    share
        s, 0 to 1: the share of the stiffness that goes through it; zero: off.
    """

    limit: float
    share: float

    def __post_init__(self) -> None:
        require_between("interface slip", "limit", self.limit, "N", 0.0, 1e6, open_low=True)
        require_between("interface slip", "share", self.share, "", 0.0, 1.0)

    @classmethod
    def at_shear(cls, shear_limit: float, shear_per_force: float, share: float) -> "InterfaceSlip":
        """From the largest shear stress on the interface.

        Parameters
        ----------
        shear_limit
            At which it slides, Pa.
        shear_per_force
            Largest shear stress on the bonded interface per force on the tool, Pa/N.
        share
            As above.
        """
        require_between("interface slip", "shear limit", shear_limit, "Pa", 0.0, 1e12, open_low=True)
        require_between("interface slip", "shear per force", shear_per_force, "Pa/N", 0.0, 1e12, open_low=True)
        return cls(shear_limit / shear_per_force, share)

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        carried, memory = self.carried(segment, memory)
        return segment.force + self.share * (carried - segment.force), memory

    def carried(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force of a body that slid as a whole; over the elastic force: how far in-plane motion is passed on."""
        last, start = memory or (0.0, 0.0)
        held = np.where(segment.touching, self.limit, 0.0)
        carried = bounded_sum(np.diff(segment.force, prepend=last), held, start)
        return carried, (float(segment.force[-1]), float(carried[-1]))


@dataclass(frozen=True)
class StressSoftening:
    """F = f (1 - s erf((1 - W / W_m) / m)), with the energy W of the base law and the largest one W_m so far.

    The pseudo-elastic law of Ogden and Roxburgh (1999, Proc R Soc A 455:2861) with s = 1 / r. The first loading is the
    base law; below the deepest depth the force is lower, the same loading and unloading. W / W_m is taken as
    d f(d) over its largest value, which is exact for every power law.

    Attributes
    ----------
    strength
        s, 0 to 0.99; zero: off.
    width
        m, 0.01 to 100: how much of the energy must be given back before the softening is full.
    """

    strength: float
    width: float = 0.5

    def __post_init__(self) -> None:
        require_between("stress softening", "strength", self.strength, "", 0.0, 0.99)
        require_between("stress softening", "width", self.width, "", 0.01, 100.0)

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        energy = np.maximum(segment.depth, 0.0) * segment.force
        largest = np.maximum.accumulate(np.maximum(energy, memory[0] if memory else 0.0))
        given_back = 1.0 - np.divide(energy, largest, out=np.ones_like(energy), where=largest > 0.0)
        return segment.force * (1.0 - self.strength * erf(given_back / self.width)), (float(largest[-1]),)
