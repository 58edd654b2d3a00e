"""Small-strain runs: the solution of a press of 1 N, scaled."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fem.arrays import FloatArray
from fem.load import Load
from fem.record import Record, largest_strain, reaction
from fem.solution import Solution, StepReport
from fem.solving import Equilibrium, State, at_rest, settle_linear

LARGEST_SMALL_STRAIN = 0.05


def unit_state(problem: Equilibrium) -> tuple[State, float]:
    """State under 1 N in linear kinematics and the reaction (N) to it.

    The tangent at rest is factorised here; its two passes of refinement bring the residual to round-off.
    """
    system, rest = problem.system.plain, at_rest(problem)
    tangent = system.tangent(rest)
    problem.solver.factorise(tangent)
    y = problem.solver.solve(problem.unit_load[:, None])[:, 0]
    force = system.linear_force(rest, y)
    y = y + problem.solver.solve((problem.unit_load - system.scatter.vector(force))[:, None])[:, 0]
    force = system.linear_force(rest, y)
    return State(y, system.linear_pressure(rest, y), 1.0), reaction(system, force)


def run_linear(
    record: Record,
    load: Load,
    warnings: tuple[str, ...],
    on_step: Callable[[StepReport], None] | None,
) -> Solution:
    """Scale the unit solution with the load.

    Parameters
    ----------
    record
        Empty record of the model.
    load
        Prescribed force (N) or depth (m).
    warnings
        Texts of the model.
    on_step
        Called after each step.
    """
    problem = record.equilibrium
    unit, unit_reaction = unit_state(problem)
    start = settle_linear(problem)
    compliance, depth = problem.depth(unit.y), problem.depth(start.y)
    strain = None if problem.system.is_displaced else largest_strain(problem.system, unit.y, finite=False)
    forces: FloatArray = load.value if load.control == "force" else (load.value - depth) / compliance
    for n, (time, force) in enumerate(zip(load.time.tolist(), forces.tolist(), strict=True)):
        state = State(start.y + force * unit.y, start.pressure + force * unit.pressure, force)
        largest = largest_strain(problem.system, state.y, finite=False) if strain is None else abs(force) * strain
        record.add(time, state, force * unit_reaction, largest)
        if on_step is not None:
            on_step(StepReport(n + 1, len(forces), time, force, problem.depth(state.y), 0, 0))
    return record.solution(None, warnings + _strain_warning(record.strains))


def _strain_warning(strains: list[float]) -> tuple[str, ...]:
    beyond = np.flatnonzero(np.array(strains) > LARGEST_SMALL_STRAIN)
    if beyond.size == 0:
        return ()
    return (
        f"SMALL-STRAIN THEORY EXCEEDED: kinematics = 'linear', but the strain reaches {100 * max(strains):.3g} % "
        f"and passes {100 * LARGEST_SMALL_STRAIN:g} % from step {int(beyond[0]) + 1} of {len(strains)} on; these "
        "results are not a prediction of a large press, use kinematics = 'finite'",
    )
