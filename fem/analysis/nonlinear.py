"""Finite-strain runs: step by step with Newton."""

from __future__ import annotations

import time as clock
from collections.abc import Callable

import numpy as np

from fem.analysis.checkpoint import Keeper, Progress
from fem.analysis.equilibrium import Equilibrium, State
from fem.analysis.linear import unit_state
from fem.analysis.newton import NewtonSettings
from fem.analysis.record import Record, largest_strain
from fem.analysis.stepping import Advance, Stepper, settle
from fem.assembly.system import System
from fem.load import Load
from fem.results.solution import Failure, Resumed, Solution, StepReport

LEAST_SHARE_OF_PEAK = 1e-3


def run_nonlinear(
    record: Record,
    load: Load,
    settings: NewtonSettings,
    warnings: tuple[str, ...],
    on_step: Callable[[StepReport], None] | None,
    checkpoint: Keeper | None = None,
) -> Solution:
    """Follow a load history in finite strain.

    Parameters
    ----------
    record
        Empty record of the model.
    load
        Prescribed force (N) or depth (m).
    settings
        Limits of Newton's method.
    warnings
        Texts of the model.
    on_step
        Called after each accepted step that was computed here.
    checkpoint
        Where the accepted steps are kept; what it holds already is not computed again.

    Raises
    ------
    CheckpointError
        If the checkpoint cannot be used.

    Returns
    -------
    Solution
        All steps that were reached, and the failure if there was one.
    """
    began = clock.process_time()
    problem = record.equilibrium
    scale = LEAST_SHARE_OF_PEAK * force_scale(problem, load)
    start, reason = settle(problem, scale, settings)
    if reason:
        failure = Failure(1, float(load.time[0]), load.control, 0.0, float(load.value[0]), reason)
        return record.solution(failure, warnings)
    stepper = Stepper(problem, load.control, scale, settings, start, load.start)
    first = 0 if checkpoint is None else _resume(record, stepper, checkpoint)
    for n, (time, value) in list(enumerate(zip(load.time.tolist(), load.value.tolist(), strict=True)))[first:]:
        advance = stepper.advance(value, time)
        if advance.reason:
            failure = Failure(n + 1, time, load.control, advance.value, value, advance.reason)
            return record.solution(failure, warnings, _between(record, stepper.problem.system, advance, start))
        system = stepper.problem.system
        _keep(record, system, time, advance.state)
        warnings = tuple(dict.fromkeys((*warnings, *system.warnings(advance.state.y))))
        if checkpoint is not None:
            checkpoint.write(_progress(record, stepper, clock.process_time() - began))
        if on_step is not None:
            depth = problem.depth(advance.state.y)
            on_step(
                StepReport(
                    n + 1,
                    len(load.time),
                    time,
                    advance.state.force,
                    depth,
                    advance.iterations,
                    advance.cuts,
                )
            )
    return record.solution(None, warnings)


def force_scale(problem: Equilibrium, load: Load) -> float:
    """Largest force in N of a load history, from the stiffness at rest if depth is prescribed."""
    largest = float(np.abs(load.value).max())
    if load.control == "force":
        return largest
    return largest / problem.depth(unit_state(problem)[0].y)


def _keep(record: Record, system: System, time: float, state: State) -> None:
    evaluation = system.evaluate(state.y, state.pressure)
    if evaluation is None:
        raise ArithmeticError("an accepted state cannot be evaluated")
    returned = system.reaction(evaluation.elements.force, evaluation.responses)
    record.add(time, state, returned, largest_strain(system, state.y, finite=True))


def _between(record: Record, system: System, advance: Advance, start: State) -> Record | None:
    """The record with the last state of equilibrium as one more row; None if it is a step's or the start's."""
    known = record.states[-1] if record.states else start
    if advance.state is known:
        return None
    further = record.copy()
    _keep(further, system, advance.time, advance.state)
    return further


def _resume(record: Record, stepper: Stepper, checkpoint: Keeper) -> int:
    """Put the steps of a checkpoint into record and stepper; how many there are."""
    found = checkpoint.read()
    if found is None:
        return 0
    for n, time, reached, strain in zip(found.steps, found.time, found.reactions, found.strains, strict=True):
        record.add(float(time), found.states[n], float(reached), float(strain))
    stepper.resume(found.values, found.times, found.states)
    record.resumed = Resumed(len(found.steps), found.seconds)
    return len(found.steps)


def _progress(record: Record, stepper: Stepper, seconds: float) -> Progress:
    known, earlier = stepper.known, 0.0 if record.resumed is None else record.resumed.seconds
    place = {id(state): n for n, state in enumerate(known.states)}
    return Progress(
        time=np.array(record.time),
        reactions=np.array(record.reactions),
        strains=np.array(record.strains),
        steps=np.array([place[id(state)] for state in record.states]),
        values=known.values,
        times=stepper.times,
        states=known.states,
        seconds=earlier + seconds,
    )
