"""Newton's method for one prescribed force or depth.

The pressure is an unknown of its own during the iteration (eliminated element by element in each linear
solve), which keeps Newton robust for nearly incompressible layers. Under depth control the force is one
more unknown: the bordered system is solved by two right-hand sides of the same factors, so the depth is
exact and the force follows, also on branches where the force falls. Where the last correction promises that one more
with the same factors suffices, no new ones are made (the simplified Newton method: P. Deuflhard, Newton Methods for
Nonlinear Problems, 2004, section 2.1). Equations that differ little from those solved before, as in the rounds of
Coulomb's law, begin with their factors and go on with them as long as each correction reduces enough.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fem.analysis.equilibrium import Equilibrium, NewtonResult, State
from fem.arrays import FloatArray
from fem.assembly.system import Evaluation
from fem.linear_solver import SingularMatrixError

MOST_ROUND_OFF = 1e3
"""In tolerances: more round-off is accepted as equilibrium only where corrections change nothing any more. A sheet much
thinner than its hole bends under forces that are less than the round-off of those that stretch it, as a large body's
far elements have more than what a tip meets, and both still have displacements and force to many digits."""
FORCING, MOST_FORCING = 1e-3, 0.1
"""Shares of the unbalanced forces that an iterative solver may leave: at least, and where less is left to do (S. C.
Eisenstat and H. F. Walker, SIAM Journal on Scientific Computing 17 (1996) 16). 1e-2 and 1e-4 took 1.1 to 1.3 times as
long."""
LAST = 0.3  # of what may stay unbalanced, the share that an iterative solver may leave in the last correction
ENOUGH = 0.25
"""Unbalanced forces over those before, with which factors of another round go on: a new factorisation costs ten times
as much as a correction with old factors."""
SAFETY = 4.0  # on the reduction by old factors; in theory twice that of the correction they were made for


@dataclass(frozen=True)
class NewtonSettings:
    """Limits of a Newton run.

    Attributes
    ----------
    tolerance
        Allowed norm of the unbalanced forces relative to the force; an iterative solver's own where that is larger.
    iterations
        Most corrections.
    halvings
        Most halvings of a correction that turns an element inside out.
    divergence
        Growth of the unbalanced forces over the best so far that counts as divergence.
    beyond_limits
        Whether a press may be followed over limit points; see :mod:`fem.analysis.limit_points`.
    misfit
        Allowed change of the limits that follow the pressure, over the force, where that is more than they allow
        themselves.
    """

    tolerance: float = 1e-9
    iterations: int = 25
    halvings: int = 5
    divergence: float = 1e6
    beyond_limits: bool = True
    misfit: float = 0.0


def solve_newton(
    problem: Equilibrium,
    guess: State,
    control: Literal["force", "depth"],
    target: float,
    force_scale: float,
    settings: NewtonSettings,
    held: Callable[[FloatArray], float] | None = None,
) -> NewtonResult:
    """Find the equilibrium at a prescribed force (N) or depth (m), from a guess, with at least one correction.

    Below the force scale in N the tolerance is not tightened further. A failure has its reason in the result. `held`
    is the round-off of factors that the solver has of nearly the same equations, to begin with; None makes new ones.
    """
    state = guess if control == "depth" else State(guess.y, guess.pressure, target)
    evaluation = problem.system.evaluate(state.y, state.pressure)
    if evaluation is None:
        return NewtonResult(state, 0, "the predicted state turns an element inside out")
    tolerance = max(settings.tolerance, problem.solver.tolerance)
    before, best, round_off, enough = _unbalanced(problem, state, evaluation), np.inf, held, ENOUGH
    for iteration in range(1, settings.iterations + 1):
        try:
            if round_off is None:
                round_off, enough = problem.factorise(evaluation), 0.0
            limit = tolerance * max(abs(state.force), force_scale)
            step = _correction(problem, state, evaluation, control, target, LAST * limit)
        except SingularMatrixError as error:
            return NewtonResult(state, iteration, str(error))
        damped = problem.system.kinked and (control == "force" or _reached(problem, state, target))
        moved = _move(problem, state, evaluation, step, settings.halvings, damped)
        if moved is None:
            return NewtonResult(state, iteration, "an element turns inside out")
        unbalanced = _unbalanced(problem, *moved)
        limit = tolerance * max(abs(moved[0].force), force_scale)
        if enough and unbalanced > max(before, limit):
            round_off = None  # held factors that lead away: from the same state with new ones
            continue
        state, evaluation = moved
        most = np.inf if _is_settled(moved[0], step, tolerance) else MOST_ROUND_OFF * limit
        if unbalanced <= limit or _is_round_off(round_off, state, unbalanced, most):
            if control == "force" or _reached(problem, state, target):
                return NewtonResult(_found(state, evaluation), iteration, round_off=round_off)
        elif unbalanced > settings.divergence * best:
            return NewtonResult(state, iteration, "the unbalanced forces grow")
        if SAFETY * unbalanced**2 > before * limit and unbalanced > enough * before:
            round_off = None
        before, best = unbalanced, min(best, unbalanced)
    return NewtonResult(state, settings.iterations, f"no equilibrium after {settings.iterations} iterations")


def _found(state: State, evaluation: Evaluation) -> State:
    """The state with the pressure of its displacements."""
    return State(state.y, evaluation.elements.consistent_pressure, state.force)


def _unbalanced(problem: Equilibrium, state: State, evaluation: Evaluation) -> float:
    """Norm of the unbalanced forces in N."""
    return float(np.linalg.norm(evaluation.residual - state.force * problem.unit_load))


def _is_round_off(round_off: Callable[[FloatArray], float], state: State, unbalanced: float, most: float) -> bool:
    """Whether what is left, `most` N or less, is no more than round-off, as with very flat elements far away."""
    return unbalanced <= most and unbalanced <= round_off(state.y)


def _is_settled(state: State, step: tuple[FloatArray, float], tolerance: float) -> bool:
    """Whether the correction that led to a state changed displacements and force by no more than a share of them."""
    dy, df = step
    return bool(np.linalg.norm(dy) <= tolerance * np.linalg.norm(state.y)) and abs(df) <= tolerance * abs(state.force)


def _reached(problem: Equilibrium, state: State, target: float) -> bool:
    return abs(problem.depth(state.y) - target) <= 1e-12 * max(abs(target), float(np.abs(state.y).max()))


def _correction(
    problem: Equilibrium,
    state: State,
    evaluation: Evaluation,
    control: Literal["force", "depth"],
    target: float,
    enough: float,
) -> tuple[FloatArray, float]:
    """Increments of the unknowns (n,) and of the force, with the factors the solver has; `enough` N may be left."""
    unbalanced = state.force * problem.unit_load - evaluation.residual
    size = float(np.linalg.norm(unbalanced))
    share = min(max(FORCING, enough / size), MOST_FORCING) if size > 0.0 else MOST_FORCING
    if control == "force":
        return problem.solve(unbalanced[:, None], share)[:, 0], 0.0
    free, loaded = problem.solve(np.stack((unbalanced, problem.unit_load), axis=1), share).T
    if loaded[problem.probe] == 0.0:
        raise SingularMatrixError("the depth does not depend on the force")
    missing = -target - state.y[problem.probe] - free[problem.probe]
    force = float(missing / loaded[problem.probe])
    return free + force * loaded, force


def _move(
    problem: Equilibrium,
    state: State,
    evaluation: Evaluation,
    step: tuple[FloatArray, float],
    halvings: int,
    damped: bool,
) -> tuple[State, Evaluation] | None:
    """Make a correction, halved until no element is inside out.

    Where it is damped (equations with kinks; not on the way to another depth, which upsets the balance) it is also
    halved while it leaves more unbalanced than before; if it always does,
    the half that leaves least is made.
    """
    dy, df = step
    pressure_step = problem.system.pressure_after(evaluation, dy) - state.pressure
    least, best = np.inf, None
    before = _unbalanced(problem, state, evaluation) if damped else np.inf
    for halving in range(halvings + 1):
        share = 0.5**halving
        moved = State(state.y + share * dy, state.pressure + share * pressure_step, state.force + share * df)
        found = problem.system.evaluate(moved.y, moved.pressure)
        if found is None:
            continue
        unbalanced = _unbalanced(problem, moved, found)
        if unbalanced < least:
            least, best = unbalanced, (moved, found)
        if unbalanced <= before:
            break
    return best
