"""What a sheet over a hole does under a load history, whichever way its tension is worked out.

A sheet that relaxes, or has options of a body, keeps its elastic law. What relaxes is the elastic force, by one scalar
state (quasi-linear viscoelasticity, Y. C. Fung, Biomechanics: Mechanical Properties of Living Tissues, section 7.6);
the field is that of the elastic sheet at the depth where it stands. A linear sheet with one series does exactly that.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError, WaveError
from wavemodel.integrators.lags import creep, relaxation
from wavemodel.integrators.load_history import Load
from wavemodel.integrators.quasi_static import answered
from wavemodel.integrators.viscoelastic import Prony
from wavemodel.physics.quasi_static_press import Physics, driven
from wavemodel.solution import checked_radii, radially


@dataclass(frozen=True)
class SheetHistory:
    """A run over n steps.

    Attributes
    ----------
    force, depth
        (n,) in N and m.
    axis
        (n, L) deflection of each layer's top face on the axis, m.
    energy
        (n,) in J, kinetic energy included; None where it is not followed.
    faces
        Step and radii (m,), up to the hole's, to (2, L + 1, m): outward and downward displacement of the faces, m.
    """

    force: FloatArray
    depth: FloatArray
    axis: FloatArray
    energy: FloatArray | None
    faces: Callable[[int, FloatArray], FloatArray]


@dataclass(frozen=True)
class SheetFaces:
    """Faces of a sheet in a run (a `FaceMotion`).

    Attributes
    ----------
    hole_radius
        In m.
    at
        See `SheetHistory.faces`.
    """

    hole_radius: float
    at: Callable[[int, FloatArray], FloatArray]

    def deflection(self, step: int, radius: FloatArray) -> FloatArray:
        """See `FaceMotion.deflection`."""
        return self._inside(step, radius)[1, :-1]

    def in_plane(self, step: int, points: FloatArray, face: int) -> FloatArray:
        """See `FaceMotion.in_plane`."""
        return radially(self._inside(step, np.hypot(points[:, 0], points[:, 1]))[0, face], points)

    def lower_face(self, step: int, radii: FloatArray) -> FloatArray:
        """(2, m): outward and downward displacement of the lower face, m, at radii (m,); NaN outside the hole.

        Raises
        ------
        WaveError
            If a radius is negative or not a number.
        """
        return self._inside(step, checked_radii(radii))[:, -1]

    def _inside(self, step: int, radius: FloatArray) -> FloatArray:
        inside = radius <= self.hole_radius
        return np.where(inside, self.at(step, np.where(inside, radius, self.hole_radius)), np.nan)


class Statics(Protocol):
    """A sheet at rest under a press."""

    def rest(self, control: str, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Force (n,) in N and depth (n,) in m where one of them, "force" or "depth", is given."""
        ...

    def field(self, depth: float, radii: FloatArray) -> FloatArray:
        """(2, L + 1, m): outward and downward displacement of the faces at radii (m,), m."""
        ...

    def run(self, load: Load) -> SheetHistory:
        """Equilibria at the instants of a load history."""
        ...


def with_relaxation(physics: Physics | None, series: Prony | None, integrator: str) -> Physics | None:
    """The options of a sheet, its relaxation among them; None where only the relaxation is on, or nothing.

    Raises
    ------
    NotCoveredError
        With inertia.
    WaveError
        If relaxation is given twice.
    """
    if integrator != "quasi_static" and (series is not None or physics is not None):
        raise NotCoveredError("the sheet over a hole does not cover inertia with relaxation or options of the body")
    if physics is None or series is None:
        return physics
    if physics.relaxation is not None:
        raise WaveError("relaxation is given twice, to the wave and in its physics: give one of them")
    return replace(physics, relaxation=series)


def relaxing_run(load: Load, statics: Statics, series: Prony, sticks: bool) -> SheetHistory:
    """Run a history of a sheet that relaxes; exact for an elastic force that is linear in each step.

    Under force control the depth is that of the force crept by the inverse of the series. By depth, a sheet that does
    not stick to the tool is not pulled.

    Raises
    ------
    WaveError
        If the sheet has no equilibrium as deep.
    """
    if load.control == "force":
        law = creep(series)
        elastic, _ = law.follow(load.durations, load.value, law.rest(load.initial(load.value)))
        return _standing(statics, load, load.value, statics.rest("force", elastic)[1])
    elastic, _ = statics.rest("depth", load.value)
    found, force = answered(relaxation(series), load, elastic, sticks)
    stands = load.value if sticks else np.maximum(load.value, 0.0)
    if found.free.any():
        stands = np.where(found.free, statics.rest("force", found.value)[1], stands)
    return replace(_standing(statics, load, force, stands), depth=load.value)


def options_run(load: Load, statics: Statics, physics: Physics, scale: float) -> SheetHistory:
    """Run a history of a sheet with options; `scale` is about the depth of the press, m.

    Raises
    ------
    WaveError
        If the sheet has no equilibrium as deep, or is pulled more than it holds.
    """
    trace = driven(load, lambda depth: statics.rest("depth", depth)[0], physics, scale)
    return replace(_standing(statics, load, trace.force, trace.surface), depth=trace.depth)


def _standing(statics: Statics, load: Load, force: FloatArray, depth: FloatArray) -> SheetHistory:
    """The elastic sheet at depths (n,), m, under other forces (n,), N."""
    return replace(statics.run(Load("depth", load.time, depth)), force=force, energy=None)
