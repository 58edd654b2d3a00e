"""Presses that are slow against the first frequency: inertia left out, damping by stiffness and fading memory kept.

The first frequency of skin on a base is a few hundred hertz, a press takes seconds. Where all layers fade alike every
mode is in the same state, x(t) times its static answer, and the whole history is one scalar.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.creep import creep, relaxation
from wavemodel.integrators.history import History
from wavemodel.integrators.load import Load
from wavemodel.integrators.prony import NO_FADING, Prony


class StaticBody(Protocol):
    """A body without inertia whose answer is made of B fields, each with its own course in time."""

    @property
    def unit(self) -> FloatArray:
        """(B, L, K) amplitudes of the fields per force, m3/N."""
        ...

    @property
    def axis(self) -> FloatArray:
        """(B, L) deflection of each layer's top face on the axis per force, m/N."""
        ...

    def follow(self, load: Load) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, B) course of each field in N, (n,) force in N and (n,) depth in m."""
        ...


@dataclass(frozen=True)
class SharedBody:
    """All layers creep alike: one field.

    Attributes
    ----------
    unit, axis
        (1, L, K) and (1, L) static answers per force by the initial moduli.
    compliance
        Initial depth per force, m/N.
    series
        Fading memory.
    retardation
        Kelvin-Voigt time, s.
    """

    unit: FloatArray
    axis: FloatArray
    compliance: float
    series: Prony = NO_FADING
    retardation: float = 0.0

    def follow(self, load: Load) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, 1) course, (n,) force, (n,) depth; exact for a force, or depth, linear in each step."""
        by_force = load.control == "force"
        law = (creep if by_force else relaxation)(self.series, self.retardation)
        driven = load.value if by_force else load.value / self.compliance
        if not self.series.strength and self.retardation == 0.0:
            return driven[:, None], driven, driven * self.compliance
        answer, _ = law.follow(load.durations, driven, law.rest(load.initial(driven)))
        course, force = (answer, driven) if by_force else (driven, answer)
        return course[:, None], force, course * self.compliance


def quasi_static(load: Load, body: StaticBody) -> History:
    """Run a load history without inertia."""
    course, force, depth = body.follow(load)
    unit = body.unit

    def amplitude(step: int) -> FloatArray:
        return np.asarray(np.einsum("b,blk->lk", course[step], unit))

    return History(force, depth, course @ body.axis, course, amplitude)
