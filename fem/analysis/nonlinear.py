"""Finite-strain runs: step by step with Newton."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fem.analysis.checkpoint import Keeper, Progress
from fem.analysis.equilibrium import Equilibrium, State
from fem.analysis.limit_points import Account
from fem.analysis.linear import unit_state
from fem.analysis.newton import NewtonSettings
from fem.analysis.prediction import GuidedStates
from fem.analysis.record import Record, largest_strain
from fem.analysis.stepping import Advance, Control, Stepper, Watch, settle
from fem.assembly.system import System
from fem.load import Load
from fem.results.solution import Failure, Resumed, Solution, StepReport

NOTICED = 1e-3
"""Share of the work below which a loss is within what the trapezoidal rule is off, and told only of a creep."""
LEAST_SHARE_OF_PEAK = 1e-3
EASED = (1e-3, 3e-2)
"""Of the stiffness against sliding, with which a state is sought first that is sought without the way there."""
EASED_LIMITS = NewtonSettings(1e-3, beyond_limits=False)


def run_nonlinear(
    record: Record,
    load: Load,
    settings: NewtonSettings,
    warnings: tuple[str, ...],
    on_step: Callable[[StepReport], None] | None,
    checkpoint: Keeper | None = None,
    watch: Watch | None = None,
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
        Where the accepted steps are kept (CheckpointError if it cannot be used); what it holds already is not computed
        again.
    watch
        Told of each state of equilibrium that is found.

    Returns
    -------
    Solution
        All steps that were reached, and the failure if there was one.
    """
    began, problem = clock.process_time(), record.equilibrium
    scale = LEAST_SHARE_OF_PEAK * force_scale(problem, load)
    start, reason = settle(problem, scale, settings)
    if reason:
        failure = Failure(1, float(load.time[0]), load.control, 0.0, float(load.value[0]), reason)
        return record.solution(failure, warnings)
    stepper = Stepper(problem, load.control, scale, settings, start, load.start, watch)
    return _Run(record, load, stepper, start, began, warnings, on_step, checkpoint).solution()


@dataclass
class _Run:
    """A run under way: the process clock at its begin in s, and the warnings so far."""

    record: Record
    load: Load
    stepper: Stepper
    start: State
    began: float
    warnings: tuple[str, ...]
    on_step: Callable[[StepReport], None] | None
    checkpoint: Keeper | None

    def solution(self) -> Solution:
        """Follow the load history to its end, or to where it cannot be followed."""
        first = 0 if self.checkpoint is None else _resume(self.record, self.stepper, self.checkpoint)
        steps = list(enumerate(zip(self.load.time.tolist(), self.load.value.tolist(), strict=True)))
        for n, (time, value) in steps[first:]:
            advance = self.stepper.advance(value, time)
            if advance.reason:
                failure = Failure(n + 1, time, self.load.control, advance.value, value, advance.reason)
                further = _between(self.record, self.stepper.problem.system, advance, self.start)
                return self._told(failure, further)
            self._accept(n + 1, time, advance)
        return self._told(None, None)

    def _told(self, failure: Failure | None, further: Record | None) -> Solution:
        """The solution with the warnings, what was lost over limit points, and from where on it is not stable."""
        accounts = [Account.of_row(row) for row in self.stepper.accounts]
        warnings = (*self.warnings, *self._snapped(accounts), *self._unstable(accounts))
        depth = self._first(accounts, "unstable")[1] if accounts[-1].unstable else None
        return replace(self.record.solution(failure, warnings, further), unstable_from=depth)

    def _unstable(self, accounts: Sequence[Account]) -> Iterator[str]:
        if accounts[-1].unstable:
            yield (
                f"the press is not stable from {self._at(accounts, 'unstable')} on: the tissue would fold or "
                "wrinkle there, and what is computed beyond is one of several equilibria, which another mesh or other "
                "steps may not share"
            )

    def _first(self, accounts: Sequence[Account], what: str) -> tuple[float, float]:
        """Force in N and depth in m where a number of the accounts first rises."""
        state = self.stepper.known.states[next(n for n, one in enumerate(accounts) if getattr(one, what))]
        return state.force, self.record.equilibrium.depth(state.y)

    def _at(self, accounts: Sequence[Account], what: str) -> str:
        force, depth = self._first(accounts, what)
        return f"{force:.4g} N and {1e3 * depth:.4g} mm"

    def _snapped(self, accounts: Sequence[Account]) -> Iterator[str]:
        crept, share = accounts[-1].crept, accounts[-1].share
        if not crept and share < NOTICED:
            return
        where = ""
        if crept:
            times = "once" if crept == 1 else f"{crept} times, first"
            where = f" ({times} at {self._at(accounts, 'crept')})"
        lost = f"{100.0 * share:.2g} %" if share >= NOTICED else f"less than {100.0 * NOTICED:g} %"
        yield (
            f"the surface snapped past the tool's edge{where}: {lost} of the tool's work was lost, "
            "and beyond that another mesh may differ by several per cent"
        )

    def _accept(self, step: int, time: float, advance: Advance) -> None:
        system, state = self.stepper.problem.system, advance.state
        _keep(self.record, system, time, state)
        self.warnings = tuple(dict.fromkeys((*self.warnings, *system.warnings(state.y))))
        if self.checkpoint is not None:
            self.checkpoint.write(_progress(self.record, self.stepper, clock.process_time() - self.began))
        if self.on_step is not None:
            total, depth = len(self.load.time), self.record.equilibrium.depth(state.y)
            self.on_step(StepReport(step, total, time, state.force, depth, advance.iterations, advance.cuts))


def equilibrium_near(
    problem: Equilibrium, guess: State, control: Control, value: float, settings: NewtonSettings
) -> State | None:
    """The state in equilibrium at a load value (N or m) that a guess leads to, without the way there, if it does.

    For equations that know all of the way that they need. Points that slide or stick by their displacements pass over
    the narrow range in which they stick: those that stick are sought with a wider one first.
    """
    scale = LEAST_SHARE_OF_PEAK * abs(guess.force)
    for share in EASED:
        eased = problem.system.eased(share)
        if eased is None:
            break
        found = Stepper(replace(problem, system=eased), control, scale, EASED_LIMITS).found_near(guess, value)
        if found.success:
            guess = replace(found.state, y=problem.system.tightened(found.state.y, share))
    found = Stepper(problem, control, scale, settings).found_near(guess, value)
    return found.state if found.success else None


def equilibrium_along(
    problem: Equilibrium, load: Load, guides: Sequence[State] | None, way: NewtonSettings, end: NewtonSettings
) -> State | None:
    """The last state of a load history, of a body with a memory; None where the way leads nowhere.

    Each step begins with the increment of its guide, another mesh's state there; without guides with the usual
    prediction. `way` and `end` are the limits of Newton's method up to the last step and in it.
    """
    scale = LEAST_SHARE_OF_PEAK * force_scale(problem, load)
    start, reason = settle(problem, scale, end)
    if reason:
        return None
    guided = None
    if guides is not None:
        value = 0.0 if load.control == "force" else problem.depth(start.y)
        guided = GuidedStates(problem, value, start, np.append(load.start, load.time), (start, *guides))
    stepper = Stepper(problem, load.control, scale, way, start, load.start, guided=guided)
    for time, target in zip(load.time.tolist(), load.value.tolist(), strict=True):
        if time == load.time[-1]:
            stepper.limit(end)
        advance = stepper.advance(target, time)
        if advance.reason:
            return None
    return advance.state


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
    stepper.resume(found.values, found.times, found.states, found.settled, found.accounts)
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
        settled=stepper.settled,
        accounts=stepper.accounts,
        seconds=earlier + seconds,
    )
