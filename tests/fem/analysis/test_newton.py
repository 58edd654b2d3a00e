import dataclasses

import numpy as np
import pytest

import fem
from fem.analysis.equilibrium import State
from fem.analysis.newton import FORCING, MOST_FORCING, MOST_ROUND_OFF, NewtonSettings, solve_newton
from fem.linear_solver import IterativeSolver
from tests.fem.linear_solver.test_iterative import block

SETTINGS = NewtonSettings()


@pytest.fixture
def problem(skin):
    return fem.prepare(skin("rigid_bonded", discretisation=fem.Discretisation("coarse"))).equilibrium


def rest(problem):
    return State(*problem.system.rest(), 0.0)


def test_force_control_balances_the_forces(problem):
    result = solve_newton(problem, rest(problem), "force", 0.3, 0.0, SETTINGS)
    assert result.success
    found = problem.system.evaluate(result.state.y, result.state.pressure)
    assert np.linalg.norm(found.residual - 0.3 * problem.unit_load) <= 0.3e-9
    np.testing.assert_allclose(result.state.pressure, found.elements.consistent_pressure, rtol=1e-9)


def test_depth_control_finds_the_same_state(problem):
    by_force = solve_newton(problem, rest(problem), "force", 0.3, 0.0, SETTINGS).state
    depth = problem.depth(by_force.y)
    by_depth = solve_newton(problem, rest(problem), "depth", depth, 0.3, SETTINGS)
    assert by_depth.success
    assert by_depth.state.force == pytest.approx(0.3, rel=1e-8)
    np.testing.assert_allclose(by_depth.state.y, by_force.y, atol=1e-9 * depth)


def test_at_least_one_correction_is_made(problem):
    state = solve_newton(problem, rest(problem), "force", 0.3, 0.0, SETTINGS).state
    assert solve_newton(problem, state, "force", 0.3, 0.0, SETTINGS).iterations == 1


def test_too_few_iterations_are_a_reason(problem):
    result = solve_newton(problem, rest(problem), "force", 2.0, 0.0, dataclasses.replace(SETTINGS, iterations=1))
    assert not result.success
    assert result.reason == "no equilibrium after 1 iterations"


def test_a_guess_inside_out_is_a_reason(problem):
    state = rest(problem)
    bad = State(state.y - 1.0, state.pressure, 0.0)
    assert "inside out" in solve_newton(problem, bad, "force", 1.0, 0.0, SETTINGS).reason


def test_round_off_above_the_forces_of_a_thin_sheet_is_equilibrium_where_nothing_changes_any_more():
    """0.002 of its hole's radius thick, it bends under less than the round-off of what stretches it."""
    sheet, hole = fem.Layer("sheet", 0.04e-3, 1e3, fem.NeoHookean(500e3, 0.3)), fem.Support("hole", 20e-3, clamp="rim")
    thin = fem.prepare(fem.Problem((sheet,), fem.Tool(2e-3, "rigid_bonded"), hole)).equilibrium
    found = solve_newton(thin, rest(thin), "depth", 0.15e-3, 0.0, SETTINGS)
    assert found.success
    assert found.iterations < 10
    left = thin.system.evaluate(found.state.y, found.state.pressure).residual - found.state.force * thin.unit_load
    assert np.linalg.norm(left) > MOST_ROUND_OFF * SETTINGS.tolerance * found.state.force
    again = solve_newton(thin, found.state, "depth", 0.15e-3, 0.0, SETTINGS)
    assert again.state.force == pytest.approx(found.state.force, rel=1e-10)


class Counting:
    """A linear solver that counts its factorisations."""

    tolerance = 0.0

    def __init__(self, solver):
        self.solver, self.count, self.solve = solver, 0, solver.solve

    def factorise(self, data):
        self.count += 1
        self.solver.factorise(data)


def test_the_last_correction_takes_the_factors_of_the_one_before(problem):
    close = solve_newton(problem, rest(problem), "force", 0.3, 0.0, SETTINGS).state
    counting = Counting(problem.solver)
    result = solve_newton(dataclasses.replace(problem, solver=counting), close, "force", 0.31, 0.0, SETTINGS)
    assert result.success
    assert counting.count == result.iterations - 1


def counted(problem, guess, held):
    """Result from a guess at 0.3001 N with held factors, and how many new ones it took."""
    counting = Counting(problem.solver)
    return solve_newton(
        dataclasses.replace(problem, solver=counting), guess, "force", 0.3001, 0.0, SETTINGS, held
    ), counting.count


def test_factors_of_nearly_the_same_equations_serve(problem):
    close = solve_newton(problem, rest(problem), "force", 0.3, 0.0, SETTINGS)
    result, count = counted(problem, close.state, close.round_off)
    anew, _ = counted(problem, close.state, None)
    assert (result.success, count) == (True, 0)
    np.testing.assert_allclose(result.state.y, anew.state.y, atol=1e-8 * np.abs(anew.state.y).max())


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_held_factors_that_do_not_serve_are_replaced(problem, sign):
    """Those of a tangent a hundred times as stiff reduce too little; those of its negative lead away."""
    close = solve_newton(problem, rest(problem), "force", 0.29, 0.0, SETTINGS)
    tangent = problem.system.tangent(problem.system.evaluate(close.state.y, close.state.pressure))
    problem.solver.factorise(sign * 100.0 * tangent)
    result, count = counted(problem, close.state, close.round_off)
    anew, wanted = counted(problem, close.state, None)
    assert (result.success, count) == (True, wanted)
    np.testing.assert_allclose(result.state.y, anew.state.y, atol=1e-8 * np.abs(anew.state.y).max())


def test_an_iterative_solver_is_not_asked_for_more_than_is_needed(monkeypatch):
    """Each correction leaves a thousandth, the last one what may be left; all end within the solver's tolerance."""
    asked = []
    solve = IterativeSolver.solve

    def note(self, right, tolerance=0.0):
        asked.append(tolerance)
        return solve(self, right, tolerance)

    monkeypatch.setattr(IterativeSolver, "solve", note)
    problem = fem.prepare(block(law=fem.NeoHookean), "iterative").equilibrium
    result = solve_newton(problem, rest(problem), "force", 0.1, 0.0, SETTINGS)
    assert result.success
    assert result.iterations == len(asked) > 2
    assert asked[0] == FORCING < asked[-1] <= MOST_FORCING
    found = problem.system.evaluate(result.state.y, result.state.pressure)
    left = np.linalg.norm(found.residual - 0.1 * problem.unit_load)
    assert 1e-3 * problem.solver.tolerance < left / 0.1 <= problem.solver.tolerance
