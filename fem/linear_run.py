"""Small-strain runs: the solution of a press of 1 N, scaled."""

from __future__ import annotations

from collections.abc import Callable

from fem.arrays import FloatArray
from fem.fading_run import run_fading
from fem.load import Load
from fem.record import Record, largest_strain
from fem.small_strain import strain_warning, unit_state
from fem.solution import Solution, StepReport
from fem.solving import State, settle_linear


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
    if problem.system.remembers:
        return run_fading(record, load, warnings, on_step)
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
    return record.solution(None, warnings + strain_warning(record.strains))
