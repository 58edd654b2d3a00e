"""The energy of a press: what the tool does is what the body takes, and what may be lost over limit points."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.analysis import stepping
from fem.analysis.limit_points import (
    BENT,
    LEAST_GAIN,
    LOST,
    MOST_LOST,
    NONE_NEAR,
    TOO_FAR,
    Account,
    creep,
    has_jumped,
    is_unstable,
    unbalanced_between,
)
from fem.analysis.newton import NewtonSettings, solve_newton
from fem.analysis.stepping import Stepper

PAD = fem.Layer("pad", 4e-3, 1e3, fem.NeoHookean(5e3, 0.49))
SETTINGS = NewtonSettings()


def pressed(steps):
    """A pad under a tool without friction, 0.6 mm deep in so many steps: equations and states, rest first."""
    tool = fem.Tool(5e-3, "rigid_frictionless", 1e-3)
    problem = fem.Problem((PAD,), tool, fem.Support("bonded"), discretisation=fem.Discretisation("coarse"))
    model = fem.prepare(problem)
    stepper = Stepper(model.equilibrium, "depth", 1e-3, SETTINGS)
    assert not any(stepper.advance(0.6e-3 * step / steps).reason for step in range(1, steps + 1))
    return stepper.problem, stepper.known.states


def account(problem, states):
    found = Account()
    for start, end in itertools.pairwise(states):
        found = found.after(problem, start, end, beyond=True)
    return found


def test_the_body_takes_what_the_tool_does():
    """Up to the trapezoidal rule, whose error goes with the square of the step, and nodes that come into touch."""
    few, many = (account(*pressed(steps)) for steps in (6, 12))
    assert abs(many.share) < 1e-3
    assert abs(many.share) < 0.5 * abs(few.share)


def test_what_the_body_takes_does_not_depend_on_the_way():
    problem, states = pressed(6)
    first, middle, last = states[1].y, states[4].y, states[-1].y
    taken = problem.system.taken
    assert taken(first, last) == pytest.approx(taken(first, middle) + taken(middle, last), rel=1e-9)
    assert taken(last, first) == pytest.approx(-taken(first, last), rel=1e-12)


def test_a_way_through_an_element_inside_out_is_not_known():
    problem, states = pressed(6)
    assert np.isnan(problem.system.taken(-30.0 * states[-1].y, states[-1].y))
    assert Account(1.0, 1.0, np.nan).overdrawn


def test_an_account_is_overdrawn_over_its_share_of_the_most_work():
    assert not Account(0.1, 1.0, 0.99 * MOST_LOST).overdrawn
    assert Account(0.1, 1.0, 1.01 * MOST_LOST).overdrawn
    made = Account(0.5, 1.0, 0.01, 3, 2)
    assert Account.of_row(made.row) == made


def test_a_creep_ends_in_the_equilibrium_that_newtons_method_finds():
    """Where there is no limit point."""
    problem, states = pressed(6)
    problem = replace(problem, system=problem.system.beyond_limits())
    before = account(problem, states[:5])
    depth = problem.depth(states[4].y) + 1e-6
    found, after = creep(problem, states[4], "depth", depth, 1e-3, SETTINGS, before)
    straight = solve_newton(problem, states[4], "depth", depth, 1e-3, SETTINGS)
    assert found.success
    np.testing.assert_allclose(found.state.force, straight.state.force, rtol=1e-6)
    np.testing.assert_allclose(found.state.y, straight.state.y, atol=1e-10)
    assert after.crept == 1
    assert after.lost > before.lost - LEAST_GAIN * after.most


BLOCK = (fem.Layer("a", 3e-3, 1e3, fem.NeoHookean(50e3, 0.48)), fem.Layer("b", 7e-3, 1e3, fem.NeoHookean(50e3, 0.48)))
FILM = (
    fem.Layer("soft", 2.29e-3, 1e3, fem.NeoHookean(106e3, 0.48)),
    fem.Layer("stiff", 1.50e-3, 1e3, fem.NeoHookean(8.76e6, 0.45)),
    fem.Layer("low", 0.21e-3, 1e3, fem.NeoHookean(335e3, 0.45)),
)


def block(layers=BLOCK, solver="auto"):
    """A soft block under a pressure, which folds its surface at the edge at half of Young's modulus."""
    tool = fem.Tool(5e-3, "uniform_pressure")
    return fem.prepare(fem.Problem(layers, tool, fem.Support("bonded")), linear_solver=solver)


def ramp(control, peak, steps):
    return fem.Load(control, np.arange(1.0, steps + 1), peak * np.arange(1, steps + 1) / steps)


@pytest.mark.parametrize("layers", [BLOCK, (replace(BLOCK[0], thickness=10e-3),)])
def test_a_pressure_ends_where_its_force_is_largest_whatever_the_steps(layers):
    """With 10, 40 and 100 rows it once came to 2.5, 3.6 and 3.4 mm, on states that nothing holds."""
    found = [block(layers).run(ramp("force", 2.0, steps)) for steps in (4, 10, 40)]
    for one in found:
        assert not one.complete
        assert NONE_NEAR in one.failure.reason
        assert "a press by depth may go on" in one.failure.reason
        assert one.failure.reached == pytest.approx(1.846, rel=5e-3)
        assert (np.diff(one.depth) > 0.0).all()
        assert not any("not stable" in said for said in one.warnings)
    at = [np.flatnonzero(np.isclose(one.force, 1.5))[0] for one in (found[0], found[2])]
    assert found[0].depth[at[0]] == pytest.approx(found[2].depth[at[1]], rel=1e-9)


@pytest.mark.parametrize("steps", [12, 24, 40, 96])
def test_a_press_by_depth_goes_on_where_its_surface_folds_and_says_so(steps):
    """Behind the fold its force, lower by 5 to 15 %, is another with other steps: once told of in some rows only."""
    found = block().run(ramp("depth", 3.6e-3, steps))
    assert found.complete
    assert sum("not stable" in said for said in found.warnings) == 1
    assert found.unstable_from == pytest.approx(2.53e-3, rel=0.02)
    stable = found.depth < found.unstable_from
    assert (np.diff(found.force[stable]) > 0.0).all()
    assert np.interp(2.4e-3, found.depth[stable], found.force[stable]) == pytest.approx(1.803, rel=2e-3)


def test_what_bends_off_a_stable_way_is_said():
    """A film that would wrinkle goes on as it was, which nothing holds: the press is told from where on."""
    found = block(FILM).run(ramp("force", 5.0, 25))
    assert found.complete
    said = next(text for text in found.warnings if "not stable" in text)
    force, depth = float(said.split(" N ")[0].split()[-1]), float(said.split(" mm ")[0].split()[-1])
    assert 4.4 < force < 4.7
    assert depth == pytest.approx(np.interp(force, found.force, 1e3 * found.depth), rel=0.01)


def test_a_hold_on_an_unstable_way_is_no_new_begin_of_it():
    stepper = Stepper(block(FILM).equilibrium, "force", 1e-3, SETTINGS)
    assert not any(stepper.advance(force).reason for force in (2.0, 4.0, 4.7, 4.7))
    assert stepper.accounts[-1, -1] > stepper.accounts[-2, -1] > 0.0
    assert stepper.advance(4.8).cuts == 0


def test_a_resumed_press_still_says_so(tmp_path):
    load, kept = ramp("force", 5.0, 25), tmp_path / "kept.npz"
    whole = block(FILM).run(load, checkpoint=kept)
    again = block(FILM).run(load, checkpoint=kept)
    assert again.resumed.steps == 25
    assert again.warnings == whole.warnings


def test_between_two_states_of_one_way_energy_is_balanced_to_the_third_order():
    stepper = Stepper(block().equilibrium, "force", 1e-3, SETTINGS)
    for force in (1.0, 1.25, 1.375, 1.5):
        assert not stepper.advance(force).reason
    problem, (_, first, second, third, last) = stepper.problem, stepper.known.states
    quarter, eighth = unbalanced_between(problem, first, second), unbalanced_between(problem, second, third)
    assert 3.0 < quarter / eighth < 5.0
    back = unbalanced_between(problem, last, third)
    assert back == pytest.approx(unbalanced_between(problem, third, last), rel=0.02)
    assert unbalanced_between(problem, second, second) == 0.0
    assert unbalanced_between(problem, third, replace(last, y=1.3 * last.y)) > 0.05
    assert np.isinf(unbalanced_between(problem, third, replace(last, y=-30.0 * last.y)))
    assert not is_unstable(problem, last, "force")


@pytest.mark.parametrize(("contact", "thickness"), [("rigid_bonded", 0.2e-3), ("uniform_pressure", 0.3e-3)])
@pytest.mark.parametrize("steps", [1, 10])
def test_a_sheet_that_stretches_is_followed_from_a_first_step_that_goes_with_the_cube(contact, thickness, steps):
    layer, hole = fem.Layer("latex", thickness, 1e3, fem.NeoHookean(2e6, 0.49)), fem.Support("hole", 50e-3)
    found = fem.prepare(fem.Problem((layer,), fem.Tool(10e-3, contact), hole)).run(ramp("depth", 5e-3, steps))
    assert found.complete
    assert found.warnings == ()


def sheet(thickness):
    """A sheet over a hole of 20 mm, held at its rim, under a pressure."""
    layer, hole = (
        fem.Layer("sheet", thickness, 1e3, fem.NeoHookean(500e3, 0.3)),
        fem.Support("hole", 20e-3, clamp="rim"),
    )
    return fem.prepare(fem.Problem((layer,), fem.Tool(2e-3, "uniform_pressure"), hole))


@pytest.mark.parametrize(
    ("thickness", "peak", "depth"), [(1e-3, 0.2, 4.57777e-3), (0.2e-3, 0.04, 4.85511e-3), (0.04e-3, 8e-3, 4.87692e-3)]
)
def test_the_rows_of_a_press_do_not_matter_to_a_thin_sheet(thickness, peak, depth):
    """Its first row bends and stretches it so much that the way on is a third of what rest and that row foretell.

    That was once a jump to another branch. 4.57774 mm: another finite-element code, in three load steps.
    """
    for steps in (3, 10, 50):
        found = sheet(thickness).run(ramp("force", peak, steps))
        assert found.complete
        assert found.warnings == ()
        assert found.depth[-1] == pytest.approx(depth, rel=2e-6)


def test_a_way_on_that_states_foretell_badly_is_no_jump():
    stepper = Stepper(sheet(1e-3).equilibrium, "force", 1e-3, SETTINGS)
    assert not any(stepper.advance(force).reason for force in (0.02, 0.0202))
    problem, (_, first, then) = stepper.problem, stepper.known.states
    way = np.linalg.norm(then.y - first.y)
    guess = replace(first, y=1.01 * first.y)
    assert np.linalg.norm(then.y - guess.y) > LOST * way
    assert not has_jumped(problem, first, then, guess, "force", 2e-4)
    sunk = problem.depth(then.y) - problem.depth(first.y)
    assert not has_jumped(problem, first, then, guess, "depth", sunk)
    elsewhere = replace(then, y=then.y + 50.0 * (then.y - first.y))
    assert has_jumped(problem, first, elsewhere, guess, "force", 2e-4)
    assert not has_jumped(problem, first, elsewhere, elsewhere, "force", 2e-4)


def test_a_stable_state_too_far_off_for_a_step_is_no_fold(monkeypatch):
    stepper = Stepper(sheet(1e-3).equilibrium, "force", 1e-3, SETTINGS)
    assert not stepper.advance(0.02).reason
    monkeypatch.setattr(stepping, "unbalanced_between", lambda *_: 1.0)
    assert stepper.advance(0.04).reason == TOO_FAR


def test_a_sheet_that_stretches_is_taken_up_with_what_its_way_has_shown():
    layer, hole = fem.Layer("latex", 0.2e-3, 1e3, fem.NeoHookean(2e6, 0.49)), fem.Support("hole", 50e-3)
    model = fem.prepare(fem.Problem((layer,), fem.Tool(10e-3, "rigid_bonded"), hole))
    left, taken = (Stepper(model.equilibrium, "depth", 1e-3, SETTINGS) for _ in range(2))
    assert not left.advance(5e-4).reason
    taken.resume(left.known.values, left.times, left.known.states, left.settled, left.accounts)
    assert taken._bent >= left._bent > BENT
    assert not taken.advance(2e-3).reason


@pytest.mark.parametrize("solver", ["auto", "superlu"])
def test_every_solver_sees_that_nothing_holds_a_state(solver):
    """The state at rest of a block whose layers would rather grow: all stiffness with its sign turned."""
    problem = block(solver=solver).equilibrium
    rest = problem.system.evaluate(*problem.system.rest())
    problem.factorise(rest)
    assert problem.solver.negative == 0
    problem.solver.factorise(-problem.system.tangent(rest))
    assert problem.solver.negative == len(problem.unit_load)
