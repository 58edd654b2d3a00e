"""The finite-element solver's own derivatives of a press by what scenarios differ in, in the harness's terms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

import fem
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models.fem_model import FemModel, run_failure
from benchmark.models.fem_problem import problem_of
from benchmark.models.fem_steps import follow_deeper
from benchmark.models.model_result import Array, Drive, LowerFace, RunFailure
from fem.analysis.prepared import Model
from fem.arrays import IntArray

STEEP = 1e-6  # of an element's length: where the radius changes less with the place in it, it stands still


@dataclass(frozen=True)
class ScenarioChange:
    """A scenario with one parameter `below` and `above` its value, in its own unit."""

    less: Scenario
    more: Scenario
    below: float
    above: float


@dataclass(frozen=True, eq=False)
class PressDerivative:
    """Derivatives of a press over its n steps by one parameter; units are divided by the parameter's.

    Attributes
    ----------
    force : (n,) array
        N; at fixed depths, where depth is prescribed.
    outward, sunk : (n, m) array or None
        Of the lower face at fixed radii, m.
    second : PressDerivative or None
        The second derivatives, where asked for.
    top : (n, L) array or None
        Of each layer's top face on the axis, m; of first derivatives.
    """

    force: Array
    outward: Array | None = None
    sunk: Array | None = None
    second: PressDerivative | None = None
    top: Array | None = None


@dataclass(frozen=True, eq=False)
class DifferentiatedPress:
    """A press of n steps, as far as it was followed, and its derivatives.

    Attributes
    ----------
    depth, force : (n,) array
        m and N.
    face : LowerFace or None
        Where it was asked for.
    by : mapping of str to PressDerivative
    failure : RunFailure or None
        Where the solver stopped early.
    mesh_error : float or None
        Estimated error of the quantity that the largest load leaves free, a share of it; None where it was not asked
        for or has no estimate.
    at_edge : (n,) array
        The part of that error that goes with the depth, at a stuck edge: shares of the force.
    """

    depth: Array
    force: Array
    face: LowerFace | None
    by: Mapping[str, PressDerivative]
    failure: RunFailure | None
    mesh_error: float | None
    at_edge: Array


def differentiated_press(
    scenario: Scenario,
    drive: Drive,
    changes: Mapping[str, ScenarioChange],
    *,
    face: bool = False,
    second: bool = False,
    judge_mesh: bool = False,
) -> DifferentiatedPress:
    """Follow a load history and differentiate each step directly.

    Parameters
    ----------
    scenario : Scenario
    drive : Drive
    changes : mapping of str to ScenarioChange
        By any name.
    face : bool
        Whether the lower face is wanted (axial symmetry only).
    second : bool
        Whether second derivatives are wanted.
    judge_mesh : bool
        Whether the error of the mesh is to be estimated, which takes further solutions.

    Raises
    ------
    UncoveredError, InputError
        As by `FemModel`.
    fem.NotDifferentiableError
        The solver has no direct derivative here.
    """
    if scenario.support.pull < 0.0:
        raise fem.NotDifferentiableError("a cylinder between grips: the solver's own derivatives are those of a press")
    load = fem.Load(drive.control, drive.time, drive.value)
    prepared = FemModel(scenario, beyond_limits=False).prepared
    problems = {key: _change(prepared.problem, each, key) for key, each in changes.items()}
    found: dict[int, fem.DifferentiatedSolution] = {}

    def run(model: Model, edge: float) -> fem.Solution:
        del edge
        steps = {
            key: replace(each, less=_meshed_like(each.less, model), more=_meshed_like(each.more, model))
            for key, each in problems.items()
        }
        found[id(model)] = fem.differentiate(model, load, steps, second=second)
        return found[id(model)].solution

    model, solution = follow_deeper(prepared, run)
    row = _lower_row(model) if face else None
    return DifferentiatedPress(
        solution.depth,
        solution.force,
        None if row is None else _face(solution, row),
        {key: _derivative(solution, each, row, model) for key, each in found[id(model)].by.items()},
        run_failure(solution, load),
        _mesh_error(model, load, solution) if judge_mesh else None,
        fem.error_at_edge(model, solution),
    )


def _mesh_error(model: Model, load: fem.Load, solution: fem.Solution) -> float | None:
    """The estimated error of the mesh at the largest load, a share, fit to be taken off."""
    found = fem.estimate_mesh_error(model, load, solution, first_order=True)
    largest = np.abs(load.value[: len(solution.time)]).max(initial=0.0)
    return None if found is None or abs(found.load) < largest else 0.01 * found.percent


def _change(told: fem.Problem, change: ScenarioChange, key: str) -> fem.ProblemChange:
    """The change in the solver's terms; on one side alone where the other is outside what the solver takes."""
    sides: list[tuple[fem.Problem, float]] = []
    for scenario, offset in ((change.less, change.below), (change.more, change.above)):
        try:
            sides.append((problem_of(scenario), offset))
        except fem.FemError as error:
            sides.append((told, 0.0))
            reason = str(error)
    (less, below), (more, above) = sides
    if below + above == 0.0:
        raise InputError(f"{key}: {reason}")
    return fem.ProblemChange(less, more, below, above)


def _meshed_like(problem: fem.Problem, model: Model) -> fem.Problem:
    return replace(problem, discretisation=model.problem.discretisation)


def _lower_row(model: Model) -> IntArray:
    """Nodes (m,) of the lower face from the axis outwards, corners and mid-sides of elements in turn."""
    nodes: IntArray = np.flatnonzero(model.mesh.base)
    return nodes[np.argsort(model.mesh.specimen_distance[nodes])]


def _face(solution: fem.Solution, row: IntArray) -> LowerFace:
    moved = solution.displacement[:, row]
    return LowerFace(solution.depth, solution.mesh.specimen_distance[row], moved[:, :, 0], -moved[:, :, -1])


def _derivative(
    solution: fem.Solution, by: fem.SolutionDerivative, row: IntArray | None, model: Model
) -> PressDerivative:
    """At fixed radii: what moving nodes bring is taken off, du/dr dr/dp of the first derivative.

    The second derivative of the face is left out there: near a clamped rim, where the face is steep, it says nothing.
    """
    top = -by.displacement[:, [int(face[0]) for face in model.mesh.interfaces], -1]
    if row is None:
        second = None if by.second is None else PressDerivative(by.second.force)
        return PressDerivative(by.force, second=second, top=top)
    radius = solution.mesh.specimen_distance[row]
    moved, velocity = solution.displacement[:, row], by.velocity[row, 0][None, :, None]
    still = by.displacement[:, row] - slopes(radius, moved) * velocity
    if by.second is None:
        second = None
    elif velocity.any():
        second = PressDerivative(by.second.force)
    else:
        bend = by.second.displacement[:, row]
        second = PressDerivative(by.second.force, bend[:, :, 0], -bend[:, :, -1])
    return PressDerivative(by.force, still[:, :, 0], -still[:, :, -1], second, top)


def slopes(radius: Array, values: Array) -> Array:
    """Derivative over the radius (2 e + 1,) of values (n, 2 e + 1, c) on e quadratic elements; at corners the mean.

    Where an element holds the square root of the distance from a corner, its slope half-way stands for that there.
    """
    rises, runs = _rises(values), _rises(radius[None, :, None])
    middle = rises[1] / runs[1]
    first, last = (
        np.where(np.abs(run) > STEEP * np.abs(runs[1]), rise / np.where(run == 0.0, 1.0, run), middle)
        for rise, run in ((rises[0], runs[0]), (rises[2], runs[2]))
    )
    out = np.empty_like(values)
    out[:, 1::2], out[:, 0], out[:, -1] = middle, first[:, 0], last[:, -1]
    out[:, 2:-1:2] = 0.5 * (last[:, :-1] + first[:, 1:])
    return out


def _rises(values: Array) -> tuple[Array, Array, Array]:
    """Derivatives of values (n, 2 e + 1, c) by the place in each of e elements, 0 to 1, at its three nodes."""
    start, middle, end = values[:, :-2:2], values[:, 1:-1:2], values[:, 2::2]
    return -3.0 * start + 4.0 * middle - end, end - start, start - 4.0 * middle + 3.0 * end
