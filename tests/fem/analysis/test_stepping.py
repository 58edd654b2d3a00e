import dataclasses

import numpy as np
import pytest

import fem
from fem.analysis import stepping
from fem.analysis.newton import NewtonSettings
from fem.analysis.prediction import HIGHEST_ORDER, LOWEST_ORDER, KnownStates
from fem.analysis.stepping import Stepper

SETTINGS = NewtonSettings()


@pytest.fixture
def problem(skin):
    return fem.prepare(skin("uniform_pressure", discretisation=fem.Discretisation("coarse"))).equilibrium


def test_a_step_too_long_for_newton_is_cut_and_reached(problem):
    few = dataclasses.replace(SETTINGS, iterations=4)
    advance = Stepper(problem, "force", 5e-3, few).advance(2.0)
    assert advance.reason == ""
    assert advance.value == 2.0
    assert advance.cuts > 0


def test_cutting_does_not_change_the_state(problem):
    few = Stepper(problem, "force", 5e-3, dataclasses.replace(SETTINGS, iterations=4)).advance(2.0)
    many = Stepper(problem, "force", 5e-3, SETTINGS)
    for value in (0.5, 1.0, 1.5, 2.0):
        last = many.advance(value)
    assert problem.depth(few.state.y) == pytest.approx(problem.depth(last.state.y), rel=1e-7)


def test_standing_still_is_reached(problem):
    stepper = Stepper(problem, "force", 5e-3, SETTINGS)
    stepper.advance(1.0)
    again = stepper.advance(1.0)
    assert (again.value, again.cuts, again.reason) == (1.0, 0, "")


def test_what_cannot_be_reached_keeps_the_last_equilibrium(problem):
    none = Stepper(problem, "force", 5e-3, dataclasses.replace(SETTINGS, iterations=1))
    advance = none.advance(3.0)
    assert advance.reason != ""
    assert advance.value < 3.0
    assert advance.cuts > 5


def test_a_prediction_of_high_order_that_fails_is_followed_by_a_plain_one(problem, monkeypatch):
    stepper = Stepper(problem, "force", 5e-3, SETTINGS)
    for value in (0.2, 0.4, 0.6, 0.8):
        stepper.advance(value)
    plain = KnownStates.predict

    def predict(self, value, highest=HIGHEST_ORDER):
        guess = plain(self, value, highest)
        return guess if highest == LOWEST_ORDER else dataclasses.replace(guess, y=guess.y - 1.0)

    monkeypatch.setattr(KnownStates, "predict", predict)
    advance = stepper.advance(1.0)
    assert (advance.value, advance.cuts, advance.reason) == (1.0, 0, "")


@pytest.mark.parametrize(("contact", "friction"), [("rigid_frictionless", None), ("rigid_frictional", 0.3)])
def test_a_sphere_meets_soft_tissue_by_its_force_as_by_its_depth(contact, friction):
    """Its tip alone touches at rest, where Newton's first correction of any force goes far too deep.

    A force at which no node is about to touch: there two states of equilibrium are up to 0.1 % apart.
    """
    soft = (fem.Layer("gel", 12e-3, 1000.0, fem.NeoHookean(20e3, 0.45)),)
    tool = fem.Tool(5e-3, contact, 5e-3, friction_coefficient=friction)
    coarse = fem.Discretisation("coarse")
    model = fem.prepare(fem.Problem(soft, tool, fem.Support("bonded"), discretisation=coarse))
    pressed = model.run(fem.Load("force", np.array([0.5, 1.0]), np.array([0.075, 0.15])))
    assert pressed.complete
    parts = np.linspace(0.1, 1.0, 10)
    lowered = model.run(fem.Load("depth", parts, parts * pressed.depth[-1]))
    assert lowered.complete
    assert lowered.force[-1] == pytest.approx(0.15, rel=1e-6 if friction is None else 1e-2)


def test_a_sphere_meets_a_half_space_that_hardly_changes_its_volume_on_the_fine_mesh():
    """Its far elements have more round-off than what the tip meets: it once did not start."""
    gel, tool = (
        fem.Layer("gel", 10e-3, 1000.0, fem.NeoHookean(20e3, 0.4999)),
        fem.Tool(5e-3, "rigid_frictionless", 5e-3),
    )
    forces = {}
    for density in ("default", "fine"):
        mesh = fem.Discretisation(density)
        model = fem.prepare(fem.Problem((gel,), tool, fem.Support("half_space"), discretisation=mesh))
        pressed = model.run(fem.Load("depth", np.array([1.0]), np.array([0.25e-3])))
        assert pressed.complete
        forces[density] = pressed.force[-1]
    assert forces["fine"] == pytest.approx(forces["default"], rel=2e-3)


@pytest.mark.parametrize(("height", "deepest"), [(30e-3, 0.375e-3), (60e-3, 0.38e-3)])
def test_a_sphere_goes_on_where_every_prediction_turns_an_element_inside_out(height, deepest):
    """States with and without the middle in touch follow each other, and it stopped at 0.027 mm between two of them."""
    gel, tool = fem.Layer("gel", height, 1000.0, fem.NeoHookean(40e3, 0.45)), fem.Tool(3e-3, "rigid_frictionless", 3e-3)
    model = fem.prepare(fem.Problem((gel,), tool, fem.Support("bonded"))).within_limits
    steps = np.arange(1.0, 5.0)
    pressed = model.run(fem.Load("depth", steps, deepest * steps / 24.0))
    assert pressed.complete
    hertz = 4.0 / 3.0 * 40e3 / (1.0 - 0.45**2) * np.sqrt(3e-3) * pressed.depth**1.5
    np.testing.assert_allclose(pressed.force, hertz, rtol=0.02)


def gel_with_friction():
    gel = (fem.Layer("gel", 6e-3, 1000.0, fem.NeoHookean(50e3, 0.48)),)
    tool = fem.Tool(5e-3, "rigid_frictional", 1e-3, friction_coefficient=0.3)
    coarse = fem.Discretisation("coarse")
    return fem.prepare(fem.Problem(gel, tool, fem.Support("bonded"), discretisation=coarse)).equilibrium


def test_friction_limits_may_be_off_by_the_misfit_that_is_allowed():
    made = {}
    for misfit in (0.0, 1e-3, 1e-2):
        stepper = Stepper(gel_with_friction(), "force", 1e-3, dataclasses.replace(SETTINGS, misfit=misfit))
        made[misfit] = stepper.advance(1.0), stepper.problem
    (exact, problem), *loose = made.values()
    assert exact.iterations > loose[0][0].iterations > loose[1][0].iterations
    for advance, _ in loose:
        assert problem.depth(advance.state.y) == pytest.approx(problem.depth(exact.state.y), rel=1e-3)


def test_under_more_force_friction_begins_with_limits_of_as_much_more_press(monkeypatch):
    """And on the way back with those of the last step."""
    problem, begun, solve = gel_with_friction(), [], stepping.solve_newton

    def solved(ahead, *given):
        begun.append(ahead.system.items[0].friction.limit.sum())
        return solve(ahead, *given)

    monkeypatch.setattr(stepping, "solve_newton", solved)
    stepper = Stepper(problem, "force", 1e-3, SETTINGS)
    for value, share in ((0.5, 0.0), (1.0, 2.0), (0.8, 1.0)):
        before = stepper.problem.system.items[0].friction.limit.sum()
        begun.clear()
        assert stepper.advance(value).cuts == 0
        assert begun[0] == pytest.approx(share * before, rel=1e-12)
