"""Viscous damping: a force with the speed of the press and without memory in a hold."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.lag_sum import slopes
from wavemodel.physics.course import Course, Memory, require


@dataclass(frozen=True)
class ViscousDamping:
    """F = f + eta df_e/dt (Kelvin-Voigt; for a linear law eta K times the speed).

    The rate is that of the step that ends at a sample, as in the layered wave.

    Attributes
    ----------
    retardation
        eta in s, 0 to 1e4; zero: off.
    """

    retardation: float

    def __post_init__(self) -> None:
        require("viscous damping", "retardation", self.retardation, "s", 0.0, 1e4)

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force that the damping adds to the elastic force of the course."""
        last = memory[0] if memory else float(course.force[0]) if course.endless else 0.0
        rate = slopes(course.duration, course.force, last)
        return np.where(course.touching, self.retardation * rate, 0.0), (float(course.force[-1]),)
