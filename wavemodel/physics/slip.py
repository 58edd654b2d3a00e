"""Interface slip: a share of the stiffness goes through an interface that slides beyond a shear limit."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.scan import bounded_sum
from wavemodel.physics.course import Course, Memory, require


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
        require("interface slip", "limit", self.limit, "N", 0.0, 1e6, open_low=True)
        require("interface slip", "share", self.share, "", 0.0, 1.0)

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
        require("interface slip", "shear limit", shear_limit, "Pa", 0.0, 1e12, open_low=True)
        require("interface slip", "shear per force", shear_per_force, "Pa/N", 0.0, 1e12, open_low=True)
        return cls(shear_limit / shear_per_force, share)

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        carried, memory = self.carried(course, memory)
        return course.force + self.share * (carried - course.force), memory

    def carried(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force of a body that slid as a whole; over the elastic force: how far in-plane motion is passed on."""
        last, start = memory or (0.0, 0.0)
        held = np.where(course.touching, self.limit, 0.0)
        carried = bounded_sum(np.diff(course.force, prepend=last), held, start)
        return carried, (float(course.force[-1]), float(carried[-1]))
