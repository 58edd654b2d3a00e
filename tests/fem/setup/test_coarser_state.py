"""The state on a mesh with larger elements: near the run's own as by the way there, and for fewer corrections."""

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.analysis import stepping
from fem.analysis.newton import NewtonSettings
from fem.setup import coarser_state, mesh_error

SKIN, MODULI, SOFT = (0.5e-3, 1.8e-3, 9e-3), (6e5, 2e5, 4e4), (2e5, 1e5, 2e4)
HOLE = fem.Support("hole", 15e-3)


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded", "rigid_frictionless"])
def test_what_is_found_from_a_state_nearby_is_what_the_way_there_leads_to(contact, ramp, monkeypatch, sheet):
    edge = 0.5e-3 if contact == "rigid_frictionless" else None
    problem = replace(sheet(contact), tool=fem.Tool(5e-3, contact, edge_radius=edge))
    load = ramp("depth", 3e-3, 25)
    model = fem.prepare(problem)
    solution = model.run(load)
    near = fem.estimate_mesh_error(model, load, solution)
    monkeypatch.setattr(mesh_error, "found_near", lambda *_: None)
    monkeypatch.setattr(coarser_state, "ELASTIC_STEPS", 25)
    followed = fem.estimate_mesh_error(model, load, solution)
    assert near.halved == pytest.approx(followed.halved, rel=1e-8)
    assert near.error == pytest.approx(followed.error, rel=1e-5)
    assert near.order == pytest.approx(followed.order, rel=1e-3)


def test_a_deep_press_is_judged_without_the_way_there(ramp, monkeypatch):
    """At the edge of a stuck tool the fine mesh's displacements turn larger elements inside out."""
    layers = tuple(
        fem.Layer(f"{n}", h, 1000.0, fem.NeoHookean(E, 0.48)) for n, (h, E) in enumerate(zip(SKIN, MODULI, strict=True))
    )
    problem = fem.Problem(layers, fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded"), "finite")
    load = ramp("depth", 4e-3, 8)
    model = fem.prepare(problem)
    solution = model.run(load)
    monkeypatch.setattr(mesh_error, "followed", lambda *_: pytest.fail("the way there was followed"))
    found = fem.estimate_mesh_error(model, load, solution)
    assert 0.0 < found.percent < 2.0


def counted_corrections(monkeypatch):
    """Newton's corrections, one entry a Newton run."""
    made, solve = [], stepping.solve_newton

    def solved(*given):
        made.append(solve(*given))
        return made[-1]

    monkeypatch.setattr(stepping, "solve_newton", solved)
    return lambda: sum(result.iterations for result in made)


def test_where_the_way_is_followed_with_friction_it_is_led_along_the_run_and_costs_half_of_its_corrections(
    ramp, monkeypatch
):
    """On a mesh with a third of the unknowns; what is found is what the usual limits find from rest."""
    layers = tuple(
        fem.Layer(f"{n}", h, 1000.0, fem.NeoHookean(E, 0.48)) for n, (h, E) in enumerate(zip(SKIN, SOFT, strict=True))
    )
    tool = fem.Tool(5e-3, "rigid_frictional", edge_radius=1e-3, friction_coefficient=0.3)
    problem, load = fem.Problem(layers, tool, fem.Support("bonded"), "finite"), ramp("force", 4.0, 8)
    made = counted_corrections(monkeypatch)
    monkeypatch.setattr(mesh_error, "found_near", lambda *_: None)
    model = fem.prepare(problem)
    solution = model.run(load)
    run = made()
    led = fem.estimate_mesh_error(model, load, solution)
    estimate = made() - run
    along = coarser_state.equilibrium_along
    monkeypatch.setattr(
        coarser_state, "equilibrium_along", lambda problem, load, _, *limits: along(problem, load, None, *limits)
    )
    fem.estimate_mesh_error(model, load, solution)
    unled = made() - run - estimate
    for name in ("WAY", "END"):
        monkeypatch.setattr(coarser_state, name, NewtonSettings(beyond_limits=False))
    usual = fem.estimate_mesh_error(model, load, solution)
    assert led.halved == pytest.approx(usual.halved, rel=3e-5)
    assert led.error == pytest.approx(usual.error, rel=0.02)
    assert estimate < 0.55 * run
    assert estimate < 0.95 * unled
    assert unled < 0.7 * (made() - run - estimate - unled)


def rounded(contact, edge=1e-3, **more):
    return fem.Tool(5e-3, contact, edge_radius=edge, **more)


RUBS = rounded("rigid_frictional", friction_coefficient=0.3)
REMEMBERS = {
    "adhesion": ({"tool": rounded("rigid_frictionless", adhesion_force=0.1)}, "depth", 2e-3, 1e-8),
    "a clamp that slides": ({"support": replace(HOLE, clamp_shear_limit=2e3)}, "depth", 2.5e-3, 1e-6),
    "a clamp under a stuck tool": (
        {"tool": fem.Tool(5e-3, "rigid_bonded"), "support": replace(HOLE, clamp_shear_limit=5e3)},
        "force",
        1.0,
        1e-6,
    ),
    "a clamp at which all but the rim sticks": (
        {
            "layers": tuple(
                fem.Layer(f"{n}", h, 1000.0, fem.NeoHookean(E, 0.48))
                for n, (h, E) in enumerate(((1.5e-3, 2e5), (2e-3, 1e5), (1.5e-3, 1.5e5)))
            ),
            "support": replace(HOLE, clamp_shear_limit=5e3),
        },
        "force",
        1.0,
        1e-4,
    ),
    "layers that slip": ({"interface_shear_limit": (None, 3e3)}, "depth", 2e-3, 1e-6),
    "layers that slip under a stuck tool": (
        {
            "layers": tuple(
                fem.Layer(f"{n}", h, 1000.0, fem.NeoHookean(E, 0.48))
                for n, (h, E) in enumerate(zip(SKIN, MODULI, strict=True))
            ),
            "tool": fem.Tool(5e-3, "rigid_bonded"),
            "support": fem.Support("bonded"),
            "interface_shear_limit": (None, 3e3),
        },
        "depth",
        2e-3,
        1e-6,
    ),
    "friction": ({"tool": RUBS}, "depth", 2e-3, 1e-4),
    "friction, and back": ({"tool": RUBS, "support": fem.Support("bonded")}, "force", 1.5, 1e-4),
}


@pytest.mark.parametrize("case", REMEMBERS)
def test_a_body_that_slides_or_sticks_is_judged_from_one_step_before(case, ramp, triangle, monkeypatch, sheet):
    """It is what the way from rest in all of its steps leads to, for fewer corrections."""
    changes, control, peak, allowed = REMEMBERS[case]
    problem = replace(sheet("uniform_pressure"), **changes)
    load = triangle(control, peak, 12) if case.endswith("back") else ramp(control, peak)
    model = fem.prepare(problem)
    solution, made = model.run(load), counted_corrections(monkeypatch)
    monkeypatch.setattr(mesh_error, "followed", lambda *_: pytest.fail("the way there was followed"))
    near = fem.estimate_mesh_error(model, load, solution)
    few = made()
    monkeypatch.undo()
    made = counted_corrections(monkeypatch)
    monkeypatch.setattr(mesh_error, "found_near", lambda *_: None)
    followed = fem.estimate_mesh_error(model, load, solution)
    assert abs(near.error - followed.error) < allowed * abs(near.value)
    assert near.order == pytest.approx(followed.order, rel=1e-3)
    assert few < 0.8 * made()


def test_a_tool_that_pulls_by_adhesion_is_judged_as_one_that_pressed_before(slab, monkeypatch):
    tool = rounded("rigid_frictionless", adhesion_force=5.0)
    model = fem.prepare(replace(slab("rigid_frictionless"), tool=tool))
    load = fem.Load("depth", np.arange(1.0, 8.0), 1e-3 * np.array([0.3, 0.6, 0.3, 0.0, -0.3, -0.6, -0.9]))
    solution = model.run(load)
    assert solution.force[-1] < 0.0
    near = fem.estimate_mesh_error(model, load, solution)
    assert near.load == pytest.approx(-0.9e-3)
    monkeypatch.setattr(mesh_error, "found_near", lambda *_: None)
    assert near.halved == pytest.approx(fem.estimate_mesh_error(model, load, solution).halved, rel=1e-6)


def test_layers_that_slip_are_carried_over_apart(sheet):
    """A shift of what is above an interface stays there; on the axis and at the border the sides are one."""
    problem = replace(sheet("uniform_pressure"), interface_shear_limit=(None, 3e3))
    mesh = fem.prepare(problem).mesh
    model = fem.prepare(replace(problem, discretisation=fem.Discretisation(halved=True)))
    moved = np.zeros((len(mesh.nodes), 2))
    moved[np.unique(mesh.elements[:, mesh.layer < 2]), 0] = 1e-5
    (found,) = coarser_state._carried_over(model, model.mesh, [coarser_state.MeshState(mesh, moved, 0.0, 1.0)])
    nodal, r = model.equilibrium.system.numbering.expand(found.y)[0], model.mesh.nodes[:, 0] / model.mesh.radius
    for layers, wanted in (((0, 1), 1e-5), ((2,), 0.0)):
        own = np.unique(model.mesh.elements[:, np.isin(model.mesh.layer, layers)])
        inside = own[(r[own] > 0.2) & (r[own] < 0.6)]
        assert inside.size > 10
        np.testing.assert_allclose(nodal[inside], np.where(model.mesh.base[inside], nodal[inside], wanted), atol=1e-12)


def test_a_body_that_relaxes_is_followed_as_by_the_usual_limits(slab, triangle, monkeypatch):
    problem = slab("rigid_bonded")
    layer = replace(problem.layers[0], relaxation=(fem.PronyTerm(0.5, 0.2),))
    model, load = fem.prepare(replace(problem, layers=(layer,))), triangle("depth", 2e-3, 8)
    solution, made = model.run(load), counted_corrections(monkeypatch)
    loose = fem.estimate_mesh_error(model, load, solution)
    few = made()
    for name in ("WAY", "END"):
        monkeypatch.setattr(coarser_state, name, NewtonSettings(beyond_limits=False))
    usual = fem.estimate_mesh_error(model, load, solution)
    assert loose.error == pytest.approx(usual.error, rel=0.01)
    assert few < 0.8 * (made() - few)
