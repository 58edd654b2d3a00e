"""The state before the first load step, and the way from one prescribed load to the next, in parts as Newton needs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal, TypeAlias

import numpy as np

from fem.analysis.equilibrium import Equilibrium, NewtonResult, State
from fem.analysis.limit_points import (
    BENT,
    GIVES_WAY,
    LEAST_BENT,
    MORE_BENT,
    NONE_NEAR,
    TOO_FAR,
    Account,
    creep,
    has_jumped,
    is_unstable,
    unbalanced_between,
)
from fem.analysis.newton import NewtonSettings, solve_newton
from fem.analysis.prediction import LOWEST_ORDER, GuidedStates, KnownStates, RecentStates
from fem.arrays import FloatArray
from fem.assembly.system import Evaluation, System
from fem.linear_solver import IterativeSolver, SingularMatrixError

SMALLEST_PART = 2.0**-8
MOST_PARTS = 400
MOST_CORRECTIONS = 60
MOST_HALVINGS = 40
"""Of the depth with which a tool first touches where its force leads nowhere."""
FIRST_TOLERANCE = 1e-2
"""Unbalanced forces over the force with which equations whose limits are only guessed are solved."""
HELD_BELOW = 2e-3
"""Tolerance below which such a round, from the second on, begins with the factors of the one before."""
MOST_OVER = 30  # limit points in a press; five were the most that was seen
MISSED = 0.2
"""Of the way from the last state, by which a prediction misses one that may lie on another branch."""
CROSSED = 0.005
"""Of the load, the longest step from a stable state to an unstable one."""
AHEAD = (1.0 / 64.0, 1.0 / 8.0)
"""How far beyond the last equilibrium, of the way to a step, the next one is looked for behind a limit point."""

Control: TypeAlias = Literal["force", "depth"]
Watch: TypeAlias = Callable[[System, State, float], None]
"""Told of each state of equilibrium with the equations that it fits and its time in s, also between two steps."""


def at_rest(problem: Equilibrium) -> Evaluation:
    """The equations at rest, without prescribed displacements."""
    plain = problem.system.plain
    rest = plain.evaluate(*plain.rest())
    if rest is None:
        raise ArithmeticError("the mesh has an element without volume")
    return rest


def settle_linear(problem: Equilibrium) -> State:
    """Small-strain state of the prescribed displacements alone; the tangent at rest must be factorised."""
    y, pressure = problem.system.rest()
    if not problem.system.is_displaced:
        return State(y, pressure, 0.0)
    system, rest = problem.system, at_rest(problem)
    for _ in range(2):
        force = system.scatter.vector(system.linear_force(rest, y))
        y = y - problem.solver.solve(force[:, None])[:, 0]
    return State(y, system.linear_pressure(rest, y), 0.0)


def settle(problem: Equilibrium, force_scale: float, settings: NewtonSettings) -> tuple[State, str]:
    """Apply the prescribed displacements at no force, in as many parts as Newton needs.

    Returns
    -------
    tuple
        The state, and why it is not the wanted one, or "".
    """
    state = State(*problem.system.rest(), 0.0)
    if not problem.system.is_displaced:
        return state, ""
    rest = at_rest(problem)
    replace(problem, system=problem.system.plain).factorise(rest)
    direction = settle_linear(problem)
    share, part, reason = 0.0, 1.0, ""
    while share < 1.0 and part > SMALLEST_PART:
        target = min(1.0, share + part)
        ahead = target - share
        guess = State(state.y + ahead * direction.y, state.pressure + ahead * direction.pressure, 0.0)
        there = replace(problem, system=problem.system.scaled(target))
        result = solve_newton(there, guess, "force", 0.0, force_scale, settings)
        if result.success:
            state, share = result.state, target
        else:
            part, reason = 0.5 * part, result.reason
    return state, "" if share >= 1.0 else f"the tool cannot be tilted: {reason}"


@dataclass(frozen=True)
class Advance:
    """How one load step ended.

    Attributes
    ----------
    state, value
        Last state of equilibrium and its load value (N or m).
    iterations
        Newton corrections in all parts together.
    cuts
        How often a part was halved.
    reason
        Why the target was not reached, or "".
    time
        Time in s of the state.
    """

    state: State
    value: float
    iterations: int
    cuts: int
    reason: str = ""
    time: float = 0.0


class Stepper:
    """Follows the equilibrium from load to load.

    Parameters
    ----------
    problem
        The equations.
    control
        What is prescribed, force (N) or depth (m).
    force_scale
        Force in N below which the tolerance is not tightened further.
    settings
        Limits of each Newton run.
    start
        State without force to start from; None for rest.
    time
        Time in s of the start; matters to equations with a memory only.
    watch
        Told of each state of equilibrium that is found.
    guided
        Predictions from another mesh, with the same start; None for those from the states that are found.
    """

    def __init__(
        self,
        problem: Equilibrium,
        control: Control,
        force_scale: float,
        settings: NewtonSettings,
        start: State | None = None,
        time: float = 0.0,
        watch: Watch | None = None,
        guided: GuidedStates | None = None,
    ) -> None:
        self._problem = problem
        self._control: Control = control
        self._force_scale = force_scale
        self._settings = settings
        self._watch = watch
        self._state = State(*problem.system.rest(), 0.0) if start is None else start
        self._value = 0.0 if control == "force" else problem.depth(self._state.y)
        self._time = time
        self._times, self._settled = [time], [problem.system.settled]
        self._known = KnownStates(self._value, self._state)
        recent = RecentStates(self._value, self._time, self._state) if problem.system.remembers else None
        self._recent = guided or recent
        self._accounts, self._unstable, self._finest, self._bent = [Account()], False, 0.0, BENT

    @property
    def accounts(self) -> FloatArray:
        """What the tool did up to each state and what was lost over limit points (k, 4); see :class:`Account`."""
        return np.stack([account.row for account in self._accounts])

    @property
    def known(self) -> KnownStates:
        """All states of equilibrium found so far."""
        return self._known

    @property
    def times(self) -> FloatArray:
        """Their times (k,) in s."""
        return np.array(self._times)

    @property
    def settled(self) -> FloatArray:
        """What the corrections had chosen (k, c) in each; see :attr:`fem.assembly.item.EquationItem.settled`."""
        return np.stack(self._settled)

    def resume(
        self, values: FloatArray, times: FloatArray, states: Sequence[State], settled: FloatArray, accounts: FloatArray
    ) -> None:
        """Go on from known states, each with its load value (k,) in N or m and its time (k,) in s, the start first."""
        rows = zip(values.tolist(), times.tolist(), states, settled, accounts, strict=True)
        for value, time, state, chosen, account in list(rows)[1:]:
            system = self._problem.system.advanced(time - self._time).as_settled(chosen)
            if not (system.items or system.remembers or value == self._value):
                self._bend(*self._strayed(system, state, value))
            self._accept(state, value, time, system, Account.of_row(account))

    @property
    def problem(self) -> Equilibrium:
        """The equations, which remember the states up to the last one."""
        return self._problem

    def limit(self, settings: NewtonSettings) -> None:
        """Limits of each Newton run from here on."""
        self._settings = settings

    def advance(self, target: float, time: float | None = None) -> Advance:
        """Go to the load value `target` at a time in s (None: at once), halving the way as often as needed."""
        start, iterations, cuts = self._value, 0, 0
        began, way = self._time, target - start
        self._finest = 2.0 * SMALLEST_PART * abs(way)
        duration = 0.0 if time is None else time - began
        share, part, folds = 0.0, 1.0, False
        for _ in range(MOST_PARTS):
            last = part >= 1.0 - share
            value = target if last else start + (share + part) * way
            end = began + duration * (1.0 if last else share + part)
            result, system = self._solve(value, end)
            iterations += result.iterations
            if result.success:
                self._accept(result.state, value, end, system, unstable=result.unstable)
                if last:
                    return Advance(self._state, value, iterations, cuts, time=self._time)
                share += part
                part *= 2.0
            else:
                part *= 0.5
                cuts += 1
                folds |= result.reason == NONE_NEAR
                if part <= SMALLEST_PART:
                    if self._touched_by_depth(target, duration) or self._goes_beyond(target, duration):
                        further = self.advance(target, time)
                        return replace(further, iterations=further.iterations + iterations, cuts=further.cuts + cuts)
                    reason = NONE_NEAR if folds else result.reason
                    return Advance(self._state, self._value, iterations, cuts, reason, self._time)
        reason = f"more than {MOST_PARTS} parts of one step"
        return Advance(self._state, self._value, iterations, cuts, reason, self._time)

    def found_near(self, guess: State, value: float) -> NewtonResult:
        """Newton's result at a load value from a guess alone, without the way there; the stepper stays where it is."""
        return self._settle(guess, value, self._problem.system, self._control)[0]

    def _touched_by_depth(self, target: float, duration: float) -> bool:
        """Make the first state of a press by force one by depth, with less than the force; whether there is one.

        A tool that touches by a point meets so little that by its force Newton's first correction goes far too deep.
        """
        if self._control == "depth" or len(self._times) > 1 or target <= 0.0:
            return False
        problem, start = self._problem, self._state
        try:
            problem.factorise(at_rest(problem))
            depth = target * problem.depth(problem.solver.solve(problem.unit_load[:, None])[:, 0])
        except SingularMatrixError:
            return False
        for _ in range(MOST_HALVINGS):
            depth *= 0.5
            found, system = self._settle(start, depth, problem.system, "depth")
            if found.success and 0.0 < found.state.force < target:
                share = found.state.force / target
                self._accept(found.state, found.state.force, self._time + share * duration, system)
                return True
        return False

    def _goes_beyond(self, target: float, duration: float) -> bool:
        """Take the equations that may be followed over limit points, or creep over one with these; whether it did.

        Only for presses that go deeper, of bodies without a memory, of which the tool's work tells what is lost.
        """
        system = self._problem.system
        deeper = self._state.force > 0.0 and target > self._value
        if system.remembers or not deeper or not self._settings.beyond_limits:
            return False
        beyond = system.beyond_limits()
        if beyond is not None:
            self._problem = replace(self._problem, system=beyond)
            return True
        allowed = system.is_beyond and self._accounts[-1].crept < MOST_OVER
        return allowed and any(self._crept(part, target, duration) for part in AHEAD)

    def _crept(self, part: float, target: float, duration: float) -> bool:
        """Creep over a limit point by a part of the way to a target; whether there is an equilibrium."""
        problem, value = self._problem, self._value + part * (target - self._value)
        way = (self._control, value, self._force_scale, self._settings)
        found, account = creep(problem, self._state, *way, self._accounts[-1])
        if not found.success or not problem.system.is_sound(found.state.y):
            return False
        self._accept(found.state, value, self._time + part * duration, problem.system, account)
        return True

    def _account_at(self, state: State, system: System) -> Account:
        """The account after the way from the last state of equilibrium to another of some equations."""
        return self._accounts[-1].after(self._problem, self._state, state, beyond=system.is_beyond)

    def _judged(self, result: NewtonResult, system: System) -> NewtonResult:
        """The result; beyond limit points it fails where the surface enters the tool, or too much work is lost."""
        if not result.success or not system.is_beyond:
            return result
        if not system.is_sound(result.state.y):
            return replace(result, reason="the surface enters the tool between its nodes")
        if self._account_at(result.state, system).overdrawn:
            return replace(result, reason=GIVES_WAY)
        return result

    def _solve(self, value: float, time: float) -> tuple[NewtonResult, System]:
        """Newton's result at a load value and a time, and the equations that fit it."""
        if self._control == "force" and (lost := self._problem.system.lets_go(value)):
            return NewtonResult(self._state, 0, lost), self._problem.system
        iterations = 0
        for guess, begun in self._beginnings(value, time):
            result, system = self._settle(guess, value, begun, self._control)
            iterations += result.iterations
            if result.success:
                result = self._followed(result, guess, value, system)
            if result.success:
                break
        if not iterations and begun.touches_by_point:  # all predictions turn an element inside out: from the last
            result, system = self._settle(self._state, value, begun, self._control)
            iterations = result.iterations
        return replace(result, iterations=iterations), system

    def _followed(self, result: NewtonResult, guess: State, value: float, system: System) -> NewtonResult:
        """A success with whether it is unstable; it fails where that, or one far from the guess, lies elsewhere.

        The first unstable state comes in a short step: there is none where the force has passed its largest.
        """
        if system.items or system.remembers:
            return result
        if value == self._value:
            return replace(result, unstable=self._unstable)
        problem, state = replace(self._problem, system=system), result.state
        missed, way = np.linalg.norm(state.y - guess.y), np.linalg.norm(state.y - self._state.y)
        begun, further = len(self._times) > 1, value - self._value
        unstable = is_unstable(problem, state, self._control)
        unstable |= begun and has_jumped(problem, self._state, state, guess, self._control, further)
        longest = max(CROSSED * max(abs(value), abs(self._value)), self._finest)
        if unstable and not self._unstable and abs(further) > longest:
            return replace(result, reason=NONE_NEAR)
        if unstable or missed > MISSED * way:
            off, square = self._strayed(system, state, value)
            if begun and not off <= max(LEAST_BENT, self._bent * square):
                return replace(result, reason=NONE_NEAR if unstable else TOO_FAR)
            self._bend(off, square)
        return replace(result, unstable=unstable)

    def _strayed(self, system: System, state: State, value: float) -> tuple[float, float]:
        """Energy unbalanced on the straight way to a state at another load value, and the squared share of the load."""
        share = abs(value - self._value) / max(abs(value), abs(self._value))
        return unbalanced_between(replace(self._problem, system=system), self._state, state), share**2

    def _bend(self, off: float, square: float) -> None:
        """Let the way go on with as much more unbalanced as an accepted step of it had."""
        if np.isfinite(off):
            self._bent = max(self._bent, MORE_BENT * off / square)

    def _beginnings(self, value: float, time: float) -> Iterator[tuple[State, System]]:
        """Predictions with the equations to begin with: under more force those of as much more press.

        On the way back, last, those of a lighter press.
        """
        system, force = self._problem.system.advanced(time - self._time), self._state.force
        for guess in self._guesses(value, time):
            heavier = system.at_press(guess.force / force) if guess.force > force > 0.0 else None
            if heavier is not None:
                yield guess, heavier
            yield guess, system
        if abs(value) < abs(self._value):
            lighter = system.at_press(max(value / self._value, 0.0))
            if lighter is not None:
                yield next(self._guesses(value, time)), lighter

    def _guesses(self, value: float, time: float) -> Iterator[State]:
        """Predictions at a load value and a time, the best first."""
        if self._recent is not None:
            yield from self._recent.predictions(value, time)
            return
        yield self._known.predict(value)
        if len(self._times) > LOWEST_ORDER + 1:
            yield self._known.predict(value, LOWEST_ORDER)

    def _settle(self, guess: State, value: float, system: System, control: Control) -> tuple[NewtonResult, System]:
        """Newton's result from a guess and equations to begin with, and the equations that fit it.

        Equations that do not fit yet are not solved to the last digit: each round begins with a tolerance a tenth of
        that of the round before, and what fits is solved, and judged, with the tolerance that is wanted. The
        last rounds differ little and begin with the factors of the round before; where that fails, with new ones.
        """
        iterations, wanted, held = 0, self._settings.tolerance, None
        direct = not isinstance(self._problem.solver, IterativeSolver)  # whose corrections cost more than what is held
        onwards = abs(value) >= abs(self._value)  # on the way back nodes let go one by one
        tolerance = max(wanted, FIRST_TOLERANCE) if system.follows_pressure and onwards else wanted
        for _ in range(MOST_CORRECTIONS):
            ahead, settings = replace(self._problem, system=system), replace(self._settings, tolerance=tolerance)
            solve = partial(solve_newton, ahead, guess, control, value, self._force_scale, settings)
            result = solve(held)
            if held is not None and not result.success:
                iterations += result.iterations
                result = solve()
            iterations += result.iterations
            other = self._corrected(system, result.state) if result.success else None
            if other is None and (tolerance <= wanted or not result.success):
                return self._judged(replace(result, iterations=iterations), system), system
            tolerance = max(wanted, 0.1 * tolerance) if other is not None else wanted
            system, guess = other or system, result.state
            held = result.round_off if tolerance < HELD_BELOW and direct else None
        return NewtonResult(guess, iterations, f"friction does not settle in {MOST_CORRECTIONS} rounds"), system

    def _corrected(self, system: System, state: State) -> System | None:
        """The equations that fit a state, where these do not, or not well enough for the settings."""
        other = system.corrected(state.y, state.force)
        if other is None or not self._settings.misfit:
            return other
        change = float(np.abs(other.settled - system.settled).sum())
        return None if change <= self._settings.misfit * abs(state.force) else other

    def _accept(
        self,
        state: State,
        value: float,
        time: float,
        system: System,
        account: Account | None = None,
        *,
        unstable: bool = False,
    ) -> None:
        """Take a state of equilibrium as the last one, with its account where a straight way there tells another."""
        account = account or self._account_at(state, system)
        account = replace(account, unstable=account.unstable + unstable)
        self._unstable = account.unstable > self._accounts[-1].unstable
        crept = account.crept > self._accounts[-1].crept
        self._accounts.append(account)
        if self._watch is not None:
            self._watch(system, state, time)
        self._problem = replace(self._problem, system=system.accepted(state.y))
        self._state, self._value, self._time = state, value, time
        self._times.append(time)
        self._settled.append(system.settled)
        self._known.add(value, state, alone=crept)
        if self._recent is not None:
            self._recent.add(value, time, state)
