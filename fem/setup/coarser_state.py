"""The state of a press on a mesh with larger elements, from states of the press on the model's own mesh.

It is sought near the state that is carried over, without the way there, where that way says nothing or one step of it
says enough; otherwise the load history is followed from rest, in few steps or led by the carried states. The meshes
themselves, and what their states tell of an error, are in :mod:`fem.setup.mesh_error`.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator

from fem.analysis.equilibrium import State
from fem.analysis.newton import NewtonSettings
from fem.analysis.nonlinear import equilibrium_along, equilibrium_near
from fem.analysis.prediction import from_displacement
from fem.load import Load
from fem.mesh.quads import Mesh
from fem.problem.problem import Problem
from fem.results.solution import Solution
from fem.threads import suited_threads

if TYPE_CHECKING:
    from fem.analysis.prepared import Model
    from fem.arrays import FloatArray
    from fem.mesh.solid import AnyMesh

ELASTIC_STEPS = 3
REMEMBERED_STEPS = 25  # of a body whose state follows from those before
PRESSED = 1e-6
"""Of the largest force, above which a tool is taken to touch: one that came off has what equilibrium leaves."""
WAY, END = (
    NewtonSettings(tolerance, misfit=misfit, beyond_limits=False) for tolerance, misfit in ((1e-3, 1e-2), (1e-6, 1e-5))
)
"""Limits on the way from rest and at its end. Beside the usual ones they changed the estimate of a mesh's error by 3e-5
of the value at most, of 22 presses with friction, and of most by 1e-6."""


@dataclass(frozen=True)
class MeshState:
    """One state of a solution: mesh, displacements (N, 2) in m of its nodes, depth in m and force in N."""

    mesh: AnyMesh
    displacement: FloatArray
    depth: float
    force: float

    @classmethod
    def of(cls, solution: Solution, step: int) -> MeshState:
        """At a step of a solution."""
        depth, force = float(solution.depth[step]), float(solution.force[step])
        return cls(solution.mesh, solution.displacement[step], depth, force)

    def unknowns(self, model: Model) -> FloatArray:
        """The unknowns (n,) of a model of the same mesh, without multipliers."""
        system = model.equilibrium.system
        y: FloatArray = np.zeros(system.numbering.count + 1)
        y[system.numbering.unknown], y[model.equilibrium.probe] = self.displacement.T, -self.depth
        return y[:-1]

    def value(self, control: str) -> float:
        """What the load leaves free, m or N."""
        return self.depth if control == "force" else self.force


def remembers(problem: Problem) -> bool:
    """Whether a state depends on those before it."""
    slides = problem.support.clamp_shear_limit is not None or any(limit is not None for limit in problem.shear_limits)
    grips = problem.touches and (problem.tool.contact == "rigid_frictional" or problem.tool.adhesion_force > 0.0)
    return slides or grips or any(layer.relaxation for layer in problem.layers)


def has_state_nearby(model: Model) -> bool:
    """Whether a state may be sought near another mesh's: of the way there the last step counts; the mesh is plane."""
    relaxes = any(layer.relaxation for layer in model.problem.layers)
    return isinstance(model.mesh, Mesh) and model.problem.kinematics != "linear" and not relaxes


def kept_steps(problem: Problem, peak: int) -> list[int]:
    """Steps up to the peak that are followed, the one before it among them; without a memory the peak alone."""
    if not remembers(problem):
        return [peak]
    kept = np.linspace(-1, peak, min(REMEMBERED_STEPS, peak + 1) + 1)[1:].round().astype(np.int64)
    return sorted({*kept.tolist(), max(0, peak - 1)})


def shortened(problem: Problem, load: Load, kept: list[int]) -> Load:
    """The history of the steps that are kept; straight to the last, in few steps, where only that counts."""
    if remembers(problem):
        return Load(load.control, load.time[kept], load.value[kept])
    count = min(ELASTIC_STEPS, kept[-1] + 1)
    part: FloatArray = np.linspace(0.0, 1.0, count + 1)[1:]
    return Load(load.control, part, load.value[kept[-1]] * part)


def found_near(model: Model, load: Load, along: Sequence[MeshState], source: Model) -> list[MeshState] | None:
    """The end of a load history on a model's mesh, from a state nearby; None where the way there counts, or is needed.

    Friction and adhesion remember where the step before left them: they get that step's state of the mesh of the
    `source`, which is given back before the end.
    """
    is_told = not remembers(model.problem) or len(along) >= min(2, len(load.time))
    if not has_state_nearby(model) or not isinstance(model.mesh, Mesh) or not is_told:
        return None
    near, settings = model.equilibrium, model.newton
    *earlier, guess = _carried_over(model, model.mesh, along[-2:] if remembers(model.problem) else along[-1:])
    if remembers(model.problem):
        system, settings = near.system, END
        if earlier:
            system = system.led(system.met(earlier[-1].y))
        y, system = system.pressed_as(
            system.met(guess.y), source.equilibrium.system, along[-1].unknowns(source), pressed=_pressed_before(along)
        )
        guess, near = replace(guess, y=y), replace(near, system=system)
    with suited_threads(model.unknowns):
        found = equilibrium_near(near, guess, load.control, float(load.value[-1]), settings)
    return None if found is None else [_state_of(model, each) for each in (*earlier, found)]


def _pressed_before(along: Sequence[MeshState]) -> bool:
    """Whether the tool pressed or pulled one step before the last of the states."""
    return len(along) > 1 and abs(along[-2].force) > PRESSED * max(abs(each.force) for each in along)


def followed(model: Model, load: Load, along: Sequence[MeshState]) -> MeshState | None:
    """The end of a load history, followed from rest; None where it cannot be without going over limit points.

    Under a tool that touches it is led by the states `along` the history. Without that the predictions from its own
    states were as good or better: larger elements at a stuck edge or a rim hold another increment.
    """
    in_steps = remembers(model.problem) and model.problem.kinematics != "linear"
    if not in_steps or not isinstance(model.mesh, Mesh):
        run = model.within_limits.run(load)
        return MeshState.of(run, -1) if run.complete else None
    guides = _carried_over(model, model.mesh, along) if model.problem.touches else None
    with suited_threads(model.unknowns):
        found = equilibrium_along(model.equilibrium, load, guides, WAY, END)
    return None if found is None else _state_of(model, found)


def _carried_over(model: Model, mesh: Mesh, pressed: Sequence[MeshState]) -> list[State]:
    """States of another mesh as guesses at those of this one, linear between its nearest nodes.

    Layers that slip on each other are apart, their nodes being at the same places.
    """
    values = np.concatenate([each.displacement for each in pressed], axis=1)
    out: FloatArray = np.empty((len(mesh.nodes), values.shape[1]))
    slips = [limit is not None for limit in model.problem.shear_limits]
    part = np.array([0, *itertools.accumulate(slips)])
    for each in range(part[-1] + 1):
        mine, theirs = (np.unique(one.elements[:, part[one.layer] == each]) for one in (mesh, pressed[0].mesh))
        places, known = mesh.nodes[mine], pressed[0].mesh.nodes[theirs]
        found: FloatArray = LinearNDInterpolator(known, values[theirs])(places)
        outside = np.isnan(found[:, 0])
        if outside.any():
            found[outside] = NearestNDInterpolator(known, values[theirs])(places[outside])
        out[mine] = found
    each_own = zip(pressed, np.split(out, len(pressed), axis=1), strict=True)
    return [from_displacement(model.equilibrium, mesh, own, each.force, each.depth) for each, own in each_own]


def _state_of(model: Model, found: State) -> MeshState:
    """A state of a model."""
    nodal = model.equilibrium.system.numbering.expand(found.y).T
    return MeshState(model.mesh, nodal, model.equilibrium.depth(found.y), found.force)
