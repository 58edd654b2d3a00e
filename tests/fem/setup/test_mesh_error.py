"""The estimated discretisation error of a mesh beside that which refinement shows."""

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.mesh.fan import Fan
from fem.setup import layout
from fem.setup.supports import SUPPORT_MODELS

STACK = ((1.5e-3, 3.5e5), (2e-3, 1.8e5), (1.5e-3, 2.6e5))
SKIN, MODULI, SOFT = (0.5e-3, 1.8e-3, 9e-3), (6e5, 2e5, 4e4), (2e5, 1e5, 2e4)
HOLE = fem.Support("hole", 15e-3)


def judged(problem, load):
    model = fem.prepare(problem)
    solution = model.run(load)
    return solution, fem.estimate_mesh_error(model, load, solution)


@pytest.mark.parametrize(("contact", "least", "most"), [("uniform_pressure", 0.5, 3.0), ("rigid_bonded", 1.0, 4.0)])
def test_small_strain_error_is_known_to_a_factor(contact, least, most, ramp, sheet):
    load = ramp("force", 1.0, 1)
    solution, found = judged(sheet(contact, "linear"), load)
    fine, _ = judged(sheet(contact, "linear", density="fine"), load)
    assert found.quantity == "depth"
    assert found.error < 0.0  # a tied mesh is too stiff
    assert least < found.error / (solution.depth[-1] - fine.depth[-1]) < most


def test_large_strain_error_is_known_to_a_factor(ramp, sheet):
    load = ramp("depth", 3e-3, 3)
    solution, found = judged(sheet("uniform_pressure"), load)
    fine, _ = judged(sheet("uniform_pressure", density="fine"), load)
    assert (found.quantity, found.load) == ("force", pytest.approx(3e-3))
    assert 0.5 < found.error / (solution.force[-1] - fine.force[-1]) < 4.0
    assert abs(found.extrapolated / fine.force[-1] - 1.0) < 0.01


RIM = fem.Support("hole", 25e-3, clamp="rim")
STUCK = {
    "a sheet held at its rim": (((1.5e-3, 2e5), (2e-3, 1e5), (1.5e-3, 1.5e5)), 0.49, 6e-3, RIM, 2.7e-3),
    "a sheet": (STACK, 0.49, 5e-3, HOLE, 1.5e-3),
    "a sheet, three fifths": (STACK, 0.49, 5e-3, HOLE, 3e-3),
    "one layer": (((5e-3, 1e5),), 0.49, 5e-3, HOLE, 1.2e-3),
    "a stiff layer on a soft one": (((1e-3, 3e5), (4e-3, 3e4)), 0.48, 5e-3, HOLE, 2.7e-3),
}


def test_what_is_left_at_the_edge_goes_with_the_square_of_the_depth(ramp, sheet):
    load = ramp("depth", 1e-3, 4)
    model = fem.prepare(sheet("rigid_bonded"))
    left = fem.error_at_edge(model, model.run(load))
    np.testing.assert_allclose(left[:3] / left[3], (np.arange(1.0, 4.0) / 4.0) ** 2, rtol=0.1)
    assert left[3] > 1e-4
    soft = replace(sheet("rigid_bonded"), layers=(fem.Layer("a", 5e-3, 1000.0, fem.NeoHookean(1e5, 0.49)),))
    deep, steps = fem.prepare(soft), ramp("depth", 3e-3, 6)
    grown = fem.error_at_edge(deep, deep.run(steps))
    assert 0.5 < grown[5] / grown[2] < 1.5  # not 4: the region is larger than the elements
    for other in (sheet("uniform_pressure"), replace(sheet("rigid_bonded"), support=fem.Support("bonded"))):
        model = fem.prepare(other)
        np.testing.assert_array_equal(fem.error_at_edge(model, model.run(load)), np.zeros(4))
    model, rest = fem.prepare(sheet("rigid_bonded")), fem.Load("depth", np.arange(2.0), np.array([0.0, 5e-4]))
    assert fem.error_at_edge(model, model.run(rest))[0] == 0.0


@pytest.mark.parametrize(("case", "control"), [*((case, "depth") for case in STUCK), ("one layer", "force")])
def test_the_error_at_a_stuck_edge_is_known_to_a_factor(case, control, monkeypatch, ramp):
    """Two and three more rings of straight elements tell the limit, from above, by first order."""
    layers, ratio, radius, support, depth = STUCK[case]
    stack = tuple(fem.Layer(f"{n}", h, 1000.0, fem.NeoHookean(E, ratio)) for n, (h, E) in enumerate(layers))
    problem = fem.Problem(stack, fem.Tool(radius, "rigid_bonded"), support, "finite")
    load = ramp("depth", depth, 4)
    if control == "force":
        load = ramp("force", fem.prepare(problem).run(load).force[-1], 4)
    solution, found = judged(problem, load)
    fine, finest = (straight(problem, rings, load, monkeypatch) for rings in (4, 5))
    value, limit = (getattr(each, found.quantity)[-1] for each in (solution, finest))
    limit += limit - getattr(fine, found.quantity)[-1]
    assert found.load == pytest.approx(load.value[-1])
    assert found.order == 2.0
    assert 0.5 < found.error / (value - limit) < 4.0


def straight(problem, rings, load, monkeypatch):
    """The press on twice as many elements in each direction, with more and straight rings at the edge."""
    monkeypatch.setattr(layout, "SQUARE_ROOT_RINGS", rings)
    monkeypatch.setattr(layout, "Fan", lambda *given, square_root: Fan(*given))
    found = fem.prepare(replace(problem, discretisation=fem.Discretisation("fine"))).run(load)
    monkeypatch.undo()
    return found


def test_elements_at_a_stuck_edge_hold_the_square_root(monkeypatch, ramp, sheet):
    """A small press of a sheet; straight elements, one ring more of them, leave ten times as much."""
    load = ramp("depth", 0.2e-3, 1)
    usual = fem.prepare(sheet("rigid_bonded")).run(load).force[-1]
    fine, finest = (straight(sheet("rigid_bonded"), rings, load, monkeypatch).force[-1] for rings in (4, 5))
    limit = 2.0 * finest - fine
    monkeypatch.setattr(layout, "SQUARE_ROOT_RINGS", 3)
    monkeypatch.setattr(layout, "Fan", lambda *given, square_root: Fan(*given))
    before = fem.prepare(sheet("rigid_bonded")).run(load).force[-1]
    assert abs(usual / limit - 1.0) < 7e-4
    assert before / limit - 1.0 > 4e-3


def test_the_error_of_first_order_is_fit_to_correct_by(ramp):
    """In a deep press of a sharp tool half to all of it is there by a mesh that is twice as fine; of the bound less."""
    layers = tuple(
        fem.Layer(f"{n}", h, 1000.0, fem.NeoHookean(E, 0.48)) for n, (h, E) in enumerate(zip(SKIN, MODULI, strict=True))
    )
    problem = fem.Problem(layers, fem.Tool(3e-3, "rigid_bonded"), fem.Support("bonded"), "finite")
    load = ramp("depth", 2.4e-3, 6)
    model, fine = fem.prepare(problem), fem.prepare(replace(problem, discretisation=fem.Discretisation("fine")))
    solution = model.run(load)
    force, finer = solution.force[-1], fine.run(load).force[-1]
    limit = finer - (force - finer) / 3.0  # the edge's elements are a quarter as large: first order
    bound, told = (fem.estimate_mesh_error(model, load, solution, first_order=each) for each in (False, True))
    assert 0.5 < (force - limit) / told.error < 1.0
    assert bound.error > 1.2 * told.error
    assert told.order == 1.0


def test_without_room_for_a_fan_the_error_to_correct_by_is_no_bound(ramp):
    """Under a first layer that is thin beside the tool; taken as first order the whole would be too large."""
    layers = tuple(
        fem.Layer(f"{n}", h, 1000.0, fem.NeoHookean(E, 0.48))
        for n, (h, E) in enumerate(zip((0.1e-3, 1.5e-3, 10e-3), (1.5e6, 0.96e6, 47.8e3), strict=True))
    )
    problem = fem.Problem(layers, fem.Tool(8e-3, "rigid_bonded"), fem.Support("bonded"), "finite")
    load = ramp("depth", 2e-3, 4)
    model, fine = fem.prepare(problem), fem.prepare(replace(problem, discretisation=fem.Discretisation("fine")))
    solution = model.run(load)
    force, finer = solution.force[-1], fine.run(load).force[-1]
    limit = finer - (force - finer) / 3.0  # second order
    bound, told = (fem.estimate_mesh_error(model, load, solution, first_order=each) for each in (False, True))
    assert 0.5 < (force - limit) / told.error < 1.0
    assert 1.0 < bound.error / (force - limit) < 4.0


@pytest.mark.parametrize("poisson_ratio", [0.3, 0.48])
@pytest.mark.parametrize("density", ["coarse", "default"])
def test_under_a_flat_punch_the_bound_is_near_the_closed_form(ramp, poisson_ratio, density):
    """It was eight to ten times what Sneddon's force is off, 2 E a d / (1 - nu^2)."""
    layer = fem.Layer("gel", np.inf, 1000.0, fem.LinearElastic(50e3, poisson_ratio))
    support, mesh = fem.Support("half_space"), fem.Discretisation(density)
    problem = fem.Problem((layer,), fem.Tool(5e-3, "rigid_frictionless"), support, "linear", discretisation=mesh)
    model, load = fem.prepare(problem), ramp("depth", 1e-4, 1)
    solution = model.run(load)
    exact = 2.0 * 50e3 * 5e-3 * 1e-4 / (1.0 - poisson_ratio**2)
    found = fem.estimate_mesh_error(model, load, solution)
    assert 1.0 < found.error / (solution.force[-1] - exact) < 6.0


BLOCKS = {
    "linear": (3e-3, 0.3, 8e-3, "linear"),
    "finite": (3e-3, 0.3, 8e-3, "finite"),
    "thick": (6e-3, 0.3, 12e-3, "finite"),
    "bonded to a base": (6e-3, 0.4999, None, "finite"),
}


def block(thickness, ratio, hole, kinematics, density="coarse"):
    layer = fem.Layer("a", thickness, 1000.0, fem.NeoHookean(3e4, ratio))
    support = fem.Support("bonded") if hole is None else fem.Support("hole", hole)
    tool = fem.Tool(4e-3, "rigid_bonded" if hole is None else "uniform_pressure")
    return fem.Problem((layer,), tool, support, kinematics, fem.Discretisation(density), "block")


@pytest.mark.parametrize(
    ("case", "density"),
    [*((case, "coarse") for case in BLOCKS), *((case, "default") for case in BLOCKS), ("linear", "fine")],
)
def test_the_error_of_a_block_is_that_of_its_rim_or_edge(case, density, ramp):
    """Against the axisymmetric solver, whose own error is a tenth of it; it was 0.4 to 0.7 and 4.5 times as large."""
    problem = block(*BLOCKS[case], density)
    load = ramp("force", 1e-4, 1) if problem.support.kind == "hole" else ramp("depth", 1.2e-3, 4)
    axial = replace(problem, geometry="axisymmetric", discretisation=fem.Discretisation("fine"))
    (_, found), (_, limit) = judged(problem, load), judged(axial, load)
    assert found.order == 1.0
    assert 0.85 < found.error / (found.value - limit.extrapolated) < 1.65


def test_where_larger_elements_of_a_block_are_softer_nothing_is_told(ramp):
    """It was told with the wrong sign."""
    problem, load = block(3e-3, 0.45, 12e-3, "linear"), ramp("force", 1e-3, 1)
    assert judged(problem, load)[1] is None
    assert judged(replace(problem, discretisation=fem.Discretisation()), load)[1].error < 0.0


def test_the_rim_of_a_hole_is_resolved_without_more_elements(monkeypatch, ramp, sheet):
    load, kind = ramp("force", 1.0, 1), SUPPORT_MODELS["hole"]
    shipped, fine = (
        judged(sheet("uniform_pressure", "linear", density=mesh), load)[0].depth[-1] for mesh in ("default", "fine")
    )
    usual = kind.extent
    monkeypatch.setattr(type(kind), "extent", lambda self, problem: replace(usual(problem), fans=()))
    plain, _ = judged(sheet("uniform_pressure", "linear"), load)
    assert abs(shipped / fine - 1.0) < 5e-4
    assert abs(plain.depth[-1] / fine - 1.0) > 5.0 * abs(shipped / fine - 1.0)


def test_a_body_that_remembers_is_followed_through_its_history(slab, triangle):
    problem = slab("uniform_pressure")
    layer = replace(problem.layers[0], relaxation=(fem.PronyTerm(0.5, 0.2),))
    solution, found = judged(replace(problem, layers=(layer,)), triangle("depth", 1e-3, 8))
    assert found.load == 1e-3
    assert found.value == pytest.approx(solution.force[3])
    assert abs(found.percent) < 1.0


def test_without_a_load_there_is_no_estimate(slab):
    load = fem.Load("depth", np.ones(1), np.zeros(1))
    assert judged(slab("uniform_pressure"), load)[1] is None


def test_where_larger_elements_fold_the_error_is_told_at_half_of_the_load(ramp):
    layers = tuple(
        fem.Layer(f"{n}", h, 1000.0, fem.NeoHookean(E, 0.48)) for n, (h, E) in enumerate(zip(SKIN, SOFT, strict=True))
    )
    tool = fem.Tool(5e-3, "rigid_frictionless", edge_radius=1e-3)
    problem = fem.Problem(layers, tool, fem.Support("bonded"), "finite")
    solution, found = judged(problem, ramp("force", 5.0, 10))
    assert solution.complete
    assert found.load == 2.5
    assert found.value == solution.depth[4]
    assert abs(found.percent) < 1.0
