"""Layers that slide on each other: limits of no and of full friction, shear, set, work, force; what is refused."""

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.analysis.newton import NewtonSettings
from fem.analysis.stepping import Stepper
from fem.setup.items import bending_modulus

SKIN = (
    fem.Layer("epidermis", 0.3e-3, 1000.0, fem.NeoHookean(4e5, 0.48)),
    fem.Layer("dermis", 1.5e-3, 1000.0, fem.NeoHookean(1e5, 0.48)),
    fem.Layer("fat", 5e-3, 1000.0, fem.NeoHookean(2e4, 0.48)),
)
LIMIT = 1e3
STEPS = np.arange(1, 41)
PRESS = fem.Load("force", STEPS / 4.0, np.minimum(STEPS, 40 - STEPS) / 20.0)


def problem(limit, **changes):
    plain = fem.Problem(
        SKIN,
        fem.Tool(5e-3, "rigid_bonded"),
        fem.Support("bonded"),
        discretisation=fem.Discretisation("coarse"),
        interface_shear_limit=limit,
    )
    return replace(plain, **changes)


def model(limit, **changes):
    return fem.prepare(problem(limit, **changes))


@pytest.fixture(scope="module")
def slipping():
    return model(LIMIT).run(PRESS)


@pytest.fixture(scope="module")
def bonded():
    return model(None).run(PRESS)


@pytest.fixture(scope="module")
def free():
    return model(0.0).run(PRESS)


def test_a_high_limit_bonds(bonded):
    found = model(1e12).run(PRESS)
    np.testing.assert_allclose(found.top_deflection, bonded.top_deflection, atol=1e-6 * bonded.depth.max())


def test_an_endless_limit_is_bonded(bonded):
    np.testing.assert_array_equal(model((np.inf, None)).run(PRESS).displacement, bonded.displacement)


def test_the_less_it_holds_the_deeper_the_press(bonded, slipping, free):
    assert 1.001 * bonded.depth.max() < slipping.depth.max() < 0.999 * free.depth.max()


@pytest.mark.parametrize("name", ["slipping", "free"])
def test_the_reaction_is_the_force(name, request):
    found = request.getfixturevalue(name)
    assert found.complete
    np.testing.assert_allclose(found.reaction, found.force, atol=1e-9 * found.force.max())


def test_only_what_slid_against_friction_keeps_a_set(bonded, slipping, free):
    assert abs(bonded.depth[-1]) < 1e-9
    assert abs(free.depth[-1]) < 1e-8
    assert abs(slipping.depth[-1]) > 1e-6


def test_the_sides_stay_together_and_slide():
    pressed = model(0.0)
    found = pressed.run(PRESS)
    part = pressed.equilibrium.system.items[1]
    upper, lower = (nodes[1:-1] for nodes in (pressed.mesh.undersides[1], pressed.mesh.interfaces[2]))
    jump = found.displacement[19][upper] - found.displacement[19][lower]
    assert 5e-5 < np.hypot(*jump.T).max() < 1e-3
    numbering = pressed.equilibrium.system.numbering
    y = np.zeros(numbering.count)
    free = numbering.unknown >= 0
    y[numbering.unknown[free]] = found.displacement[19].T[free]
    place = found.displacement[19].T[:, lower] + pressed.mesh.nodes[lower].T
    line = np.linspace(0.0, part.curve.radius[-2], 4001)
    curve = np.einsum("cmn,cn->cm", part.curve.weights(line)[0], np.append(y, 0.0)[part.along])
    curve += [line, np.full_like(line, pressed.mesh.nodes[lower[0], 1])]
    assert np.hypot(*(curve[:, :, None] - place[:, None])).min(axis=0).max() < 1e-5


def test_fields_show_the_jump(slipping):
    fields = slipping.fields(19)
    places, where = np.unique(fields.points, axis=0, return_inverse=True)
    twice = np.flatnonzero(np.bincount(where.ravel()) == 2)
    moved = [np.ptp(fields.displacement[where.ravel() == n], axis=0).max() for n in twice]
    assert len(places) < len(fields.points)
    assert max(moved) > 1e-5


def test_what_a_cycle_loses_is_limit_times_slip(elastic_energy):
    """Shear stress along the deformed interface never above the limit; the tool's lost work is the friction's."""
    equilibrium = model(LIMIT).equilibrium
    stepper = Stepper(equilibrium, "force", 1e-3, NewtonSettings())
    lost, most, depth = 0.0, 0.0, [0.0]
    for value in PRESS.value.tolist():
        before = stepper.problem.system.items
        y = stepper.advance(value).state.y
        for old, part in zip(before, stepper.problem.system.items, strict=True):
            state = part.evaluate(y)
            most = max(most, float(np.abs(state.friction / state.stretch / part.friction.limit).max()))
            step = state.friction * (part.friction.anchor - old.friction.anchor)
            assert (step >= -1e-15).all()
            lost += float(step.sum())
        depth.append(equilibrium.depth(y))
    held = sum(
        0.5 * float((part.give / part.hold * part.evaluate(y).friction ** 2).sum())
        for part in stepper.problem.system.items
    )
    stored = elastic_energy(stepper.problem.system, y) + held
    work = np.trapezoid(np.append(0.0, PRESS.value), depth)
    assert most == pytest.approx(1.0, abs=1e-6)
    assert lost > 1e-6
    assert work - stored == pytest.approx(lost, rel=5e-3)


def test_a_stopped_run_goes_on(slipping, tmp_path):
    path, short = tmp_path / "run.npz", []

    def stop(step):
        short.append(step)
        if len(short) == 30:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        model(LIMIT).run(PRESS, stop, path)
    np.testing.assert_allclose(model(LIMIT).run(PRESS, None, path).depth, slipping.depth, atol=1e-12)


def test_a_checkpoint_belongs_to_its_limit(tmp_path):
    path = tmp_path / "run.npz"
    short = fem.Load("force", np.ones(1), np.array([0.1]))
    model(LIMIT).run(short, None, path)
    with pytest.raises(fem.FemError, match="of another problem"):
        model(2.0 * LIMIT).run(short, None, path)


@pytest.mark.parametrize(
    "changes",
    [
        {"tool": fem.Tool(5e-3, "uniform_pressure")},
        {"tool": fem.Tool(5e-3, "rigid_frictional", 1e-3, friction_coefficient=0.3)},
        {"support": fem.Support("hole", 15e-3, 5e3)},
        {"support": fem.Support("half_space")},
        {"pretension": 1e3},
        {"layers": tuple(replace(layer, relaxation=(fem.PronyTerm(0.3, 1.0),)) for layer in SKIN)},
    ],
    ids=["pressure", "touching", "clamp", "half_space", "pretension", "relaxation"],
)
def test_with_every_other_part(changes):
    load = fem.Load("force", np.arange(1, 7) / 6.0, 0.4 * np.array([1, 2, 3, 2, 1, 0]))
    found, held = (model(limit, **changes).run(load) for limit in (LIMIT, None))
    assert found.complete
    assert abs(found.depth.max() / held.depth.max() - 1.0) > 5e-4
    np.testing.assert_allclose(found.reaction, found.force, atol=1e-6 * found.force.max())


def test_a_prescribed_depth_gives_the_force_back(slipping):
    up = slice(0, 20)
    load = fem.Load("depth", PRESS.time[up], slipping.depth[up])
    np.testing.assert_allclose(model(LIMIT).run(load).force, slipping.force[up], rtol=1e-6)


def test_a_thin_or_soft_side_bends_more():
    apart, joined = problem((0.0, 0.0)), problem((None, 0.0))
    assert bending_modulus(apart, 0, -1) < bending_modulus(apart, 1, 1)
    assert bending_modulus(joined, 1, -1) == joined.layers[1].material.shear_modulus
    assert bending_modulus(joined, 2, 1) == joined.layers[2].material.shear_modulus


@pytest.mark.parametrize(
    ("limit", "changes", "message"),
    [
        (-1.0, {}, "must be from 0 to 1e"),
        (float("nan"), {}, "must be from 0 to 1e"),
        (2e12, {}, r"or inf \(bonded\)"),
        ((1e3,), {}, "1 values for 3 layers, which have 2 interfaces"),
        (1e3, {"layers": SKIN[:1]}, "0 values for 1 layers"),
        (1e3, {"kinematics": "linear"}, "use kinematics = 'finite'"),
        (0.0, {"geometry": "block"}, "only with geometry = 'axisymmetric'"),
    ],
)
def test_what_cannot_slide_is_refused(limit, changes, message):
    with pytest.raises(fem.FemError, match=f"interface_shear_limit.*{message}"):
        problem(limit, **changes)
