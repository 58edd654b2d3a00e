"""Dry friction: hysteresis that does not depend on rate."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.scan import FADED, fading_sum
from wavemodel.physics.course import Course, Memory, require


@dataclass(frozen=True)
class DryFriction:
    """F = f + z, dz/dd = (F_c sign(d') - z) / length * sign(d'): Dahl's model, solved exactly between samples.

    From rest z rises over the length to F_c = force + coefficient f and swings between -F_c and +F_c; a wide cycle
    loses 2 F_c a unit of depth. As the length goes to zero it is Coulomb's friction. It ends with the contact.
    (P. R. Dahl 1968, A solid friction model, TOR-0158(3107-18)-1.)

    Attributes
    ----------
    force
        Part of F_c that does not depend on the press, N, 0 to 1e3; zero, with a zero coefficient: off.
    length
        Over which friction builds up, m, 1e-9 to 1.
    coefficient
        Of the elastic force, 0 to 10.
    """

    force: float
    length: float
    coefficient: float = 0.0

    def __post_init__(self) -> None:
        require("dry friction", "force", self.force, "N", 0.0, 1e3)
        require("dry friction", "length", self.length, "m", 1e-9, 1.0)
        require("dry friction", "coefficient", self.coefficient, "", 0.0, 10.0)

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) friction that acts beside the elastic force of the course."""
        depth = np.where(course.touching, course.depth, 0.0)
        last, start = memory or (float(depth[0]) if course.endless else 0.0, 0.0)
        moved = np.diff(depth, prepend=last)
        left = np.diff(course.touching, prepend=True) & ~course.touching
        way = np.where(left, FADED, np.where(course.touching, np.abs(moved) / self.length, 0.0))
        limit = np.where(course.touching, self.force + self.coefficient * np.abs(course.force), 0.0)
        friction = fading_sum(way, -np.expm1(-way) * np.sign(moved) * limit, start)
        friction = np.where(course.touching, friction, 0.0)
        return friction, (float(depth[-1]), float(friction[-1]))
