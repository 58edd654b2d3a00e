"""Pretension: a stiffness from tension that is there before the press, which does not scale with thickness cubed."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.physics.course import Course, Memory, require


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
        require("pretension", "stiffness", self.stiffness, "N/m", 0.0, 1e6)

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
        require("pretension", "tension", tension, "N/m", 0.0, 1e6)
        require("pretension", "tool radius", tool_radius, "m", 0.0, 0.999 * hole_radius, open_low=True)
        return cls(float(2.0 * np.pi * tension / np.log(hole_radius / tool_radius)))

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        return course.force + np.where(course.touching, self.stiffness * course.depth, 0.0), memory
