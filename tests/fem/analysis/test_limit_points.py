"""The energy of a press: what the tool does is what the body takes, and what may be lost over limit points."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.analysis.limit_points import LEAST_GAIN, MOST_LOST, Account, creep
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
    made = Account(0.5, 1.0, 0.01, 3)
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
