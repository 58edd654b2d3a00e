"""Relaxation: the elastic force fades with a Prony series (quasi-linear viscoelasticity)."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.creep import relaxation
from wavemodel.integrators.lag_sum import LagMemory
from wavemodel.integrators.prony import Prony
from wavemodel.physics.course import Course, Memory


@dataclass(frozen=True)
class Relaxation:
    """F(t) = int G(t - t') df(t'), G = 1 - sum g_j (1 - e^(-t / tau_j)); exact for f linear in each step.

    Y. C. Fung, Biomechanics: Mechanical Properties of Living Tissues, section 7.6.

    Attributes
    ----------
    series
        g_j (together below 1) and tau_j in s.
    """

    series: Prony

    def act(self, course: Course, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force."""
        law = relaxation(self.series)
        start = law.rest(float(course.force[0]) if course.endless else 0.0)
        if memory:
            start = LagMemory(memory[0], np.array(memory[1:]))
        force, end = law.follow(course.duration, course.force, start)
        return force, (end.last, *end.state.tolist())
