"""A punch that touches a block, against axial symmetry and against itself moved and tilted."""

import numpy as np
import pytest

import fem
from fem.analysis.equilibrium import Equilibrium

SOFT = ((1e-2, 2e4),)
SKIN = ((1e-4, 1e6), (1.5e-3, 1e5), (1e-2, 2e4))
TILT = np.radians(6.0)


def model(geometry="block", layers=SOFT, density="coarse", x=0.0, kinematics="finite", border=0.018, **tool):
    stack = tuple(fem.Layer(f"layer {n}", h, 1e3, fem.NeoHookean(E, 0.48)) for n, (h, E) in enumerate(layers))
    words = {"contact": "rigid_frictionless", "edge_radius": 1e-3, **tool}
    punch = fem.Tool(5e-3, position=(x, 0.0), **words)
    rest = (kinematics, fem.Discretisation(density, border), geometry)
    return fem.prepare(fem.Problem(stack, punch, fem.Support("bonded"), *rest))


def press(control, *values):
    return fem.Load(control, np.arange(1.0, len(values) + 1.0), np.array(values))


def both(**tool):
    """A wide block, and the same body in axial symmetry on a finer mesh."""
    return model(border=0.05, **tool), model("axisymmetric", density="default", border=0.05, **tool)


def tool_forces(pressed, solution):
    """Force (3,) in N of the tool on the computed half of the tissue, and its moment about y through the axis."""
    system, mesh = pressed.equilibrium.system, pressed.mesh
    unknown, u = system.numbering.unknown, solution.displacement[-1].T
    y = np.zeros(system.numbering.count)
    y[unknown[unknown >= 0]] = u[unknown >= 0]
    body = system.elements.evaluate(system.element_displacement(y), solution.pressure[-1])
    force = np.append(system.scatter.vector(body.force), 0.0)[unknown] * mesh.top
    x, _, z = mesh.nodes.T + u
    return force.sum(axis=1), float((z * force[0] - (x - mesh.axis_point[0]) * force[2]).sum())


@pytest.mark.parametrize("edge_radius", [1e-3, 5e-3])
def test_a_centred_press_is_that_of_axial_symmetry(edge_radius):
    load = press("depth", 2e-4, 6e-4)
    block, axial = both(edge_radius=edge_radius)
    block, axial = block.run(load), axial.run(load)
    np.testing.assert_allclose(block.force, axial.force, rtol=1.5e-2)
    np.testing.assert_allclose(block.reaction, block.force, rtol=1e-6)
    np.testing.assert_allclose(block.depth, load.value, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("friction", [None, 0.3])
def test_a_press_of_skin_is_that_of_axial_symmetry(friction):
    contact = "rigid_frictionless" if friction is None else "rigid_frictional"
    load = press("force", 0.5, 1.0, 1.5, 2.0)
    words = {"layers": SKIN, "density": "default", "border": None, "contact": contact, "friction_coefficient": friction}
    block, axial = (model(geometry, **words).run(load) for geometry in ("block", "axisymmetric"))
    np.testing.assert_allclose(block.top_deflection, axial.top_deflection, rtol=5e-3)
    np.testing.assert_allclose(block.reaction, load.value, rtol=1e-6)


def test_unloading_retraces_loading_until_the_punch_leaves():
    solution = model().run(press("depth", 5e-4, 1e-3, 5e-4, 0.0, -5e-4, 5e-4))
    assert solution.complete
    np.testing.assert_allclose(solution.force[[2, 5]], solution.force[0], rtol=1e-6)
    np.testing.assert_allclose(solution.force[3:5], 0.0, atol=1e-7)
    assert np.abs(solution.displacement[4]).max() < 1e-8
    np.testing.assert_allclose(solution.reaction, solution.force, atol=1e-6 * solution.force.max())


def test_force_and_depth_control_agree():
    pressed = model()
    by_force = pressed.run(press("force", 0.05, 0.1))
    np.testing.assert_allclose(by_force.reaction, [0.05, 0.1], rtol=1e-6)
    by_depth = pressed.run(press("depth", *by_force.depth))
    np.testing.assert_allclose(by_depth.force, [0.05, 0.1], rtol=1e-6)


def test_the_tissue_does_not_enter_a_tilted_punch():
    pressed = model(tilt=TILT)
    solution = pressed.run(press("depth", 4e-4, 1e-3))
    top = pressed.mesh.top
    place = (pressed.mesh.nodes[top] + solution.displacement[-1, top]).T
    place[2] += solution.depth[-1]
    gap = pressed.equilibrium.system.items[-1].punch.gap(place).distance
    assert gap.min() > -1e-6
    assert (gap < 1e-6).sum() > 10
    np.testing.assert_allclose(solution.reaction, solution.force, rtol=1e-6)


def test_a_tilted_punch_touches_first_on_its_lower_side_and_its_mirror_image_on_the_other():
    """Its upper end leans towards +x, so that its face is lower there and presses there: a moment towards +x."""
    load, answers = press("depth", 3e-4), []
    for sign in (1.0, -1.0):
        pressed = model(tilt=sign * TILT, x=sign * 2e-3)
        solution = pressed.run(load)
        (contact,) = pressed.equilibrium.system.items
        touched = contact.place[0, np.abs(contact.punch.gap(contact.place).distance) < 3e-4] - sign * 2e-3
        assert (sign * touched > 0.0).all()
        answers.append((solution.force[0], *tool_forces(pressed, solution)))
    (plus, lateral_plus, turn_plus), (minus, lateral_minus, turn_minus) = answers
    assert plus == pytest.approx(minus, rel=1e-8)
    assert turn_plus == pytest.approx(-turn_minus, rel=1e-6)
    assert 2e-3 * plus < turn_plus < 5e-3 * plus
    assert lateral_plus[0] == pytest.approx(-lateral_minus[0], rel=1e-6)
    assert lateral_plus[2] == pytest.approx(-plus, rel=1e-6)


def test_hardly_any_tilt_is_none():
    load = press("depth", 4e-4)
    upright, leaning = (model(tilt=tilt).run(load).force[0] for tilt in (0.0, 1e-7))
    assert leaning == pytest.approx(upright, rel=1e-4)


def test_an_off_centre_press_of_a_wide_block_is_the_centred_one():
    load = press("depth", 4e-4)
    centred, moved = (model(x=x, border=0.04).run(load).force[0] for x in (0.0, 4e-3))
    assert moved == pytest.approx(centred, rel=3e-3)


def test_adhesion_holds_until_the_pull_is_too_much():
    depth = 1e-4 * np.array([5.0, -1.0, -2.0, -10.0, 5.0])
    held = model(adhesion_force=100.0).run(press("depth", *depth[:2])).force
    assert held[1] < 0.0
    weak = model(adhesion_force=1.2 * abs(held[1])).run(press("depth", *depth)).force
    assert weak[1] == pytest.approx(held[1], rel=1e-6)
    np.testing.assert_allclose(weak[2:4], 0.0, atol=1e-7)
    assert weak[4] == pytest.approx(held[0], rel=1e-6)


def test_a_pull_beyond_adhesion_ends_where_the_tool_lets_go():
    """Newton's method looked for an equilibrium for minutes."""
    solution = model(adhesion_force=0.05).run(press("force", 0.1, -0.051))
    assert solution.failure.step == 2
    assert -0.05 < solution.failure.reached < -0.049
    assert "lets go of the tissue: it is pulled by more than 0.05 N" in solution.failure.reason


def test_friction_lies_between_frictionless_and_stuck():
    load, frictional = press("depth", 2e-4, 4e-4), {"contact": "rigid_frictional", "friction_coefficient": 0.3}
    block, axial = (pressed.run(load) for pressed in both(**frictional))
    free = model(border=0.05).run(load)
    stuck = model(contact="rigid_bonded", edge_radius=None, border=0.05).run(load)
    assert 1.01 * free.force[1] < block.force[1] < 0.9 * stuck.force[1]
    np.testing.assert_allclose(block.force, axial.force, rtol=1.5e-2)
    np.testing.assert_allclose(block.reaction, block.force, rtol=1e-6)


def test_a_frictional_press_of_skin_goes_back_to_no_force_at_once():
    layers, reports = ((1e-4, 1.5e6), (1.5e-3, 9.6e5), (1e-2, 4.78e4)), []
    pressed = model(layers=layers, border=None, contact="rigid_frictional", friction_coefficient=0.3)
    solution = pressed.run(press("force", 0.5, 0.0), on_step=reports.append)
    assert [report.cuts for report in reports] == [0, 0]
    assert solution.force[-1] == 0.0
    assert abs(solution.depth[-1]) < 1e-9
    assert np.abs(solution.displacement[-1]).max() < 1e-9


@pytest.mark.slow
def test_a_tilted_punch_with_friction_is_dragged_sideways_less_than_it_could_be():
    pressed = model(tilt=TILT, contact="rigid_frictional", friction_coefficient=0.3)
    solution = pressed.run(press("depth", 2e-4, 4e-4))
    assert solution.complete
    force, _ = tool_forces(pressed, solution)
    angle = np.arctan2(abs(force[0]), -force[2])
    assert angle < TILT + np.arctan(0.3)
    np.testing.assert_allclose(solution.reaction, solution.force, rtol=1e-6)


@pytest.mark.slow
def test_skin_is_pressed_to_five_newton():
    layers = ((1e-4, 1.5e6), (1.5e-3, 9.6e5), (1e-2, 4.78e4))
    load = press("force", *np.arange(0.5, 5.1, 0.5))
    block, axial = (
        model(geometry, layers=layers, density=density, border=None).run(load)
        for geometry, density in (("block", "default"), ("axisymmetric", "fine"))
    )
    assert block.complete
    np.testing.assert_allclose(block.top_deflection, axial.top_deflection, rtol=5e-3)


@pytest.mark.parametrize(
    ("words", "change"),
    [
        ("only a tool of contact 'rigid_bonded'", {"tilt": 0.1, "kinematics": "linear"}),
        ("needs an upright tool", {"tilt": 0.1, "adhesion_force": 1.0}),
        ("edge_radius is missing", {"edge_radius": None}),
        ("reaches the border", {"x": 0.015}),
    ],
)
def test_what_does_not_fit_is_refused(words, change):
    with pytest.raises(fem.FemError, match=words):
        model(**change)


def test_linear_kinematics_keeps_the_tie():
    tied = model(kinematics="linear", edge_radius=None)
    assert tied.equilibrium.system.numbering.unknown.max() + 1 == tied.unknowns


@pytest.mark.slow
def test_friction_takes_at_most_three_times_the_factorisations(monkeypatch):
    """They and the assembly before each are nearly all of the time of a press."""
    counts, factorise = [], Equilibrium.factorise

    def counted(equilibrium, state):
        counts[-1] += 1
        return factorise(equilibrium, state)

    monkeypatch.setattr(Equilibrium, "factorise", counted)
    for words in ({}, {"contact": "rigid_frictional", "friction_coefficient": 0.3}):
        counts.append(0)
        assert model(layers=SKIN, border=None, **words).run(press("force", 0.25, 0.5, 0.75, 1.0, 1.25)).complete
    assert counts[1] <= 3 * counts[0]
