"""Stress softening with the deepest depth: the Mullins effect."""

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from wavemodel.arrays import FloatArray
from wavemodel.physics.course import Course, Memory, require


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
        require("stress softening", "strength", self.strength, "", 0.0, 0.99)
        require("stress softening", "width", self.width, "", 0.01, 100.0)

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        energy = np.maximum(course.depth, 0.0) * course.force
        largest = np.maximum.accumulate(np.maximum(energy, memory[0] if memory else 0.0))
        given_back = 1.0 - np.divide(energy, largest, out=np.ones_like(energy), where=largest > 0.0)
        return course.force * (1.0 - self.strength * erf(given_back / self.width)), (float(largest[-1]),)
