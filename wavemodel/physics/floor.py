"""Bottoming out: beyond a depth a stiff floor is met."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.physics.course import Course, Memory, require


@dataclass(frozen=True)
class Floor:
    """F = f(d) + k max(d - d_f, 0): one-sided contact with a floor that yields elastically (Winkler).

    Attributes
    ----------
    depth
        d_f in m, 0 to 10.
    stiffness
        k in N/m, 0 to 1e8; zero: off.
    """

    depth: float
    stiffness: float

    def __post_init__(self) -> None:
        require("floor", "depth", self.depth, "m", 0.0, 10.0)
        require("floor", "stiffness", self.stiffness, "N/m", 0.0, 1e8)

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        return course.force + self.stiffness * np.maximum(course.depth - self.depth, 0.0), memory
