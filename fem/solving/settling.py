"""The state before the first load step: at rest, or with prescribed displacements and no force."""

from __future__ import annotations

from dataclasses import replace

from fem.assembly import Evaluation
from fem.solving.equilibrium import Equilibrium
from fem.solving.newton import NewtonSettings, solve_newton
from fem.solving.state import State

SMALLEST_PART = 2.0**-8


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
    problem.solver.factorise(problem.system.plain.tangent(rest))
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
