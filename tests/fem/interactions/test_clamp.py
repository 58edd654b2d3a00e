"""A sheet over a hole that slides on the plate round it: limits of no and of full friction, set, work and force."""

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.analysis.newton import NewtonSettings
from fem.analysis.stepping import Stepper
from fem.interactions.active_set import Friction
from fem.interactions.clamp import ClampFriction
from fem.setup.supports import SUPPORT_MODELS

SHEET = (
    fem.Layer("skin", 1.5e-3, 1000.0, fem.NeoHookean(1e5, 0.48)),
    fem.Layer("fat", 5e-3, 1000.0, fem.NeoHookean(2e4, 0.48)),
)
STEPS = np.arange(1, 41)
SLIDING = fem.Support("hole", 15e-3, 1e9)
PRESS = fem.Load("force", STEPS / 4.0, np.minimum(STEPS, 40 - STEPS) / 20.0)


def model(limit, **changes):
    tool, support = fem.Tool(5e-3, "rigid_bonded"), fem.Support("hole", 15e-3, limit)
    mesh = fem.Discretisation("coarse")
    return fem.prepare(replace(fem.Problem(SHEET, tool, support, discretisation=mesh), **changes))


@pytest.fixture(scope="module")
def sliding():
    return model(5e3).run(PRESS)


@pytest.fixture(scope="module")
def held():
    return model(None).run(PRESS)


def test_a_high_limit_holds_the_sheet(monkeypatch, held):
    sliding, kind = model(1e9).run(PRESS).depth, SUPPORT_MODELS["hole"]
    np.testing.assert_allclose(sliding, held.depth, atol=6e-3 * held.depth.max())  # another mesh at the rim
    usual = kind.extent
    monkeypatch.setattr(type(kind), "extent", lambda self, told: usual(replace(told, support=SLIDING)))
    alike = model(None).run(PRESS).depth
    np.testing.assert_allclose(sliding, alike, atol=5e-4 * alike.max())


def test_a_prescribed_depth_gives_the_force_back(sliding):
    up = slice(0, 20)
    load = fem.Load("depth", PRESS.time[up], sliding.depth[up])
    np.testing.assert_allclose(model(5e3).run(load).force, sliding.force[up], rtol=1e-6)


def test_without_friction_the_plate_is_a_row_of_rollers():
    free = model(0.0)
    plain = replace(free.equilibrium, system=free.equilibrium.system.plain)
    rollers = replace(free, equilibrium=plain)
    np.testing.assert_allclose(free.run(PRESS).depth, rollers.run(PRESS).depth, atol=1e-9)


def test_the_less_it_holds_the_deeper_the_press(held, sliding):
    assert held.depth.max() < sliding.depth.max() < model(0.0).run(PRESS).depth.max()


def test_the_reaction_is_the_force(sliding):
    assert sliding.complete
    np.testing.assert_allclose(sliding.reaction, sliding.force, atol=1e-6 * sliding.force.max())


def test_only_a_sheet_that_slid_keeps_a_set(held, sliding):
    assert abs(held.depth[-1]) < 1e-9
    assert sliding.depth[-1] > 1e-5
    assert abs(model(0.0).run(PRESS).depth[-1]) < 1e-9


def test_what_the_press_loses_in_a_cycle_is_what_the_friction_takes(elastic_energy):
    problem = model(5e3).equilibrium
    stepper = Stepper(problem, "force", 1e-3, NewtonSettings())
    lost, depth = 0.0, [0.0]
    for value in PRESS.value.tolist():
        (before,) = stepper.problem.system.items
        y = stepper.advance(value).state.y
        (after,) = stepper.problem.system.items
        force = after.respond(y).force
        assert (np.abs(force) <= after.friction.limit * (1.0 + 1e-9)).all()
        lost += float(force @ (after.friction.anchor - before.friction.anchor))
        depth.append(problem.depth(y))
    stored = elastic_energy(stepper.problem.system, y) + 0.5 * float((force**2 / after.friction.stick).sum())
    work = np.trapezoid(np.append(0.0, PRESS.value), depth)
    assert lost > 1e-5
    assert work == pytest.approx(lost + stored, rel=5e-3)


def test_a_sheet_that_slides_everywhere_says_so(sliding):
    assert not sliding.warnings
    (warning,) = model(1.0).run(PRESS).warnings
    assert "slides on all of the plate" in warning


@pytest.mark.parametrize(
    ("limit", "kind", "kinematics", "message"),
    [
        (1e3, "bonded", "finite", "only with 'hole'"),
        (-1.0, "hole", "finite", "must be from 0"),
        (float("nan"), "hole", "finite", "must be from 0"),
        (1e3, "hole", "linear", "only with kinematics = 'finite'"),
    ],
)
def test_what_cannot_slide_is_refused(limit, kind, kinematics, message):
    def problem():
        support = fem.Support(kind, 15e-3 if kind == "hole" else None, limit)
        return fem.Problem(SHEET, fem.Tool(5e-3, "rigid_bonded"), support, kinematics)

    with pytest.raises(fem.FemError, match=message):
        problem()


def test_a_stopped_run_goes_on(sliding, tmp_path):
    path, short = tmp_path / "run.npz", []

    def stop(step):
        short.append(step)
        if len(short) == 30:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        model(5e3).run(PRESS, stop, path)
    np.testing.assert_allclose(model(5e3).run(PRESS, None, path).depth, sliding.depth, atol=1e-9)


def test_it_gives_elastically_slides_at_the_limit_and_comes_back():
    slider = ClampFriction(np.array([1]), Friction(np.array([2.0]), np.array([3.0]), np.zeros(1)))
    force, slope = [], []
    for u in (1.0, 1.5, 4.0, 3.0, 0.5):
        y = np.array([9.0, u])
        force.append(slider.respond(y).force[0])
        slope.append(slider.respond(y).stiffness[0])
        slider = slider.accepted(y)
    np.testing.assert_allclose(force, [2.0, 3.0, 3.0, 1.0, -3.0])
    np.testing.assert_allclose(slope, [2.0, 2.0, 0.0, 2.0, 0.0])
    np.testing.assert_allclose(slider.friction.anchor, [2.0])


def test_the_stiffness_is_the_derivative_of_the_force():
    slider = ClampFriction(np.arange(3), Friction(np.array([1.0, 2.0, 3.0]), np.ones(3), np.array([0.0, 0.1, -5.0])))
    y, step = np.array([0.5, -0.2, 0.3]), 1e-7
    slope = (slider.respond(y + step).force - slider.respond(y - step).force) / (2.0 * step)
    np.testing.assert_allclose(slider.respond(y).stiffness, slope, atol=1e-8)


@pytest.mark.parametrize(("moved", "everywhere"), [(0.9, False), (1.1, True)])
def test_everywhere(moved, everywhere):
    slider = ClampFriction(np.arange(2), Friction(np.ones(2), np.ones(2), np.zeros(2)))
    assert bool(slider.warning(np.array([2.0, moved]))) is everywhere


def test_what_sticks_to_a_softer_plate_has_the_same_friction_where_it_is_put_on_the_real_one():
    slider = ClampFriction(np.arange(3), Friction(np.full(3, 50.0), np.ones(3), np.array([0.0, 0.1, 0.2])))
    y = np.array([0.5, -0.4, 9.0])
    eased = slider.eased(0.02)
    put = slider.tightened(y, 0.02)
    np.testing.assert_allclose(eased.respond(y).force, [0.5, -0.5, 1.0])
    np.testing.assert_allclose(slider.respond(put).force, eased.respond(y).force)
    assert put[2] == y[2]  # slides


def test_after_a_way_in_one_direction_it_slides_on_from_where_it_is():
    """As by equilibrium from step to step: elastic up to the limit, not what a mesh without that stiffness has."""
    slider = ClampFriction(np.arange(2), Friction(np.full(2, 10.0), np.ones(2), np.zeros(2)))
    y = np.array([0.05, -2.0])
    np.testing.assert_allclose(slider.led(y).friction.anchor, slider.accepted(y).friction.anchor)
    np.testing.assert_allclose(slider.led(y).friction.anchor, [0.0, -1.9])
