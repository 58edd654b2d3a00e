"""Bottoming out: beyond a depth a stiff floor is met."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.physics.course import Course, Memory, require

LENGTH = 1e-3
"""m, where the stiffness of a floor is told."""


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
        require("floor", "depth", self.depth, "m", 0.0, 10.0)
        require("floor", "stiffness", self.stiffness, "N/m", 0.0, 1e8)
        require("floor", "power", self.power, "", 1.0, 3.0)

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        beyond = np.maximum(course.depth - self.depth, 0.0) / LENGTH
        return course.force + self.stiffness * LENGTH * beyond**self.power, memory
