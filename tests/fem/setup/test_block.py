"""The block against the axisymmetric solver, against itself moved and tilted, and as data for a file."""

from dataclasses import replace

import numpy as np
import pytest

import fem

SKIN = (("epidermis", 1e-4, 1e6), ("dermis", 1.5e-3, 1e5), ("fat", 1e-2, 2e4))
RADII = np.array([0.0, 2.0, 4.0, 6.0, 10.0, 20.0]) * 1e-3


def press(force, n=2):
    k = np.arange(1, n + 1)
    return fem.Load("force", k / n, force * k / n)


def skin(
    contact="uniform_pressure",
    kinematics="linear",
    geometry="block",
    x=0.0,
    y=0.0,
    tilt=0.0,
    density="coarse",
    radius=None,
    nu=0.48,
    support=fem.Support("bonded"),  # noqa: B008 (frozen)
):
    layers = tuple(fem.Layer(name, h, 1000.0, fem.NeoHookean(modulus, nu)) for name, h, modulus in SKIN)
    tool = fem.Tool(5e-3, contact, position=(x, y), tilt=tilt)
    return fem.Problem(layers, tool, support, kinematics, fem.Discretisation(density, radius), geometry)


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded", "rigid_frictionless"])
def test_small_presses_are_those_of_the_axisymmetric_solver(contact):
    block, axial = (
        fem.prepare(skin(contact, geometry=geometry, density="default")).run(press(0.1, 1))
        for geometry in ("block", "axisymmetric")
    )
    np.testing.assert_allclose(block.top_deflection, axial.top_deflection, rtol=5e-3)
    difference = block.profile(0, RADII) - axial.profile(0, RADII)
    assert np.abs(difference).max() < 5e-3 * axial.depth[0]
    np.testing.assert_allclose(block.reaction, block.force, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_large_presses_are_those_of_the_axisymmetric_solver(contact):
    block, axial = (
        fem.prepare(skin(contact, "finite", geometry, density="default")).run(press(2.0, 4))
        for geometry in ("block", "axisymmetric")
    )
    np.testing.assert_allclose(block.top_deflection[-1], axial.top_deflection[-1], rtol=5e-3)
    np.testing.assert_allclose(block.reaction, block.force, rtol=1e-6)


@pytest.mark.parametrize("support", [fem.Support("bonded"), fem.Support("hole", 0.02)])
def test_a_finite_press_in_force_and_in_depth(support):
    model = fem.prepare(skin(kinematics="finite", support=support))
    by_force = model.run(press(0.3))
    by_depth = model.run(fem.Load("depth", by_force.time, by_force.depth))
    np.testing.assert_allclose(by_depth.force, by_force.force, rtol=1e-6)
    np.testing.assert_allclose(by_force.reaction, by_force.force, rtol=1e-6)


def test_a_sheet_over_a_hole_is_the_axisymmetric_one():
    support = fem.Support("hole", 0.02)
    block, axial = (
        fem.prepare(skin("rigid_bonded", geometry=geometry, density="default", support=support)).run(press(0.01, 1))
        for geometry in ("block", "axisymmetric")
    )
    np.testing.assert_allclose(block.top_deflection, axial.top_deflection, rtol=5e-3)


def test_an_off_centre_press_of_a_wide_specimen_is_the_centred_one_moved():
    centred, moved = (fem.prepare(skin(x=x, radius=0.08)).run(press(0.1, 1)) for x in (0.0, 0.01))
    np.testing.assert_allclose(moved.top_deflection, centred.top_deflection, rtol=2e-3)
    np.testing.assert_allclose(moved.profile(0, RADII), centred.profile(0, RADII), atol=5e-3 * float(centred.depth[0]))
    assert moved.mesh.images == 2
    assert centred.mesh.images == 4


def test_an_off_centre_hole_is_not_symmetric():
    """Near the rim a sheet is stiffer."""
    support = fem.Support("hole", 0.02)
    centred, moved = (fem.prepare(skin(x=x, support=support)).run(press(0.01, 1)) for x in (0.0, 0.01))
    assert moved.depth[0] < 0.9 * centred.depth[0]


def test_a_small_tilt_turns_the_surface_under_the_tool_and_leaves_the_press():
    tilt = np.radians(2.0)
    tilted = fem.prepare(skin("rigid_bonded", tilt=tilt)).run(press(0.1, 1))
    upright = fem.prepare(skin("rigid_bonded")).run(press(0.1, 1))
    np.testing.assert_allclose(tilted.depth, upright.depth, rtol=5e-3)
    r = np.array([1e-3, 4e-3])
    np.testing.assert_allclose(tilted.profile(0, r)[0] - tilted.depth[0], np.sin(tilt) * r, rtol=1e-9)
    np.testing.assert_allclose(tilted.reaction, tilted.force, rtol=1e-6)


def test_a_tilted_tool_at_large_strain():
    model = fem.prepare(skin("rigid_bonded", "finite", tilt=np.radians(5.0)))
    solution = model.run(fem.Load("force", np.array([1.0, 2.0]), np.array([0.2, 0.0])))
    assert solution.complete
    np.testing.assert_allclose(solution.profile(0, np.array([5e-3]))[0] - solution.depth[0], 4.3578e-4, rtol=1e-3)
    np.testing.assert_allclose(solution.reaction, solution.force, atol=1e-7)
    assert abs(solution.depth[1]) < 0.2 * solution.depth[0]


def test_fields_are_whole_hexahedra():
    solution = fem.prepare(skin("uniform_pressure", "finite")).run(press(0.1, 1))
    fields = solution.fields(0)
    assert fields.cell_type == 29
    assert fields.cells.shape[1] == 27
    corners = fields.points[fields.cells[:, :8]]
    edges = corners[:, [1, 3, 4]] - corners[:, [0]]
    assert (np.linalg.det(edges) > 0.0).all()
    np.testing.assert_allclose(fields.points[fields.cells[:, 26]].mean(axis=0), corners.mean(axis=(0, 1)), atol=1e-3)
    assert fields.displacement.shape == fields.points.shape
    stress = fields.cauchy_stress
    assert stress.shape == (len(fields.cells), 3, 3)
    np.testing.assert_allclose(stress, stress.swapaxes(1, 2), atol=1e-9 * np.abs(stress).max())
    assert np.abs(fields.det_F - 1.0).max() < 0.1


@pytest.mark.parametrize("density", ["coarse", "default", "fine"])
def test_half_as_many_elements_are_larger_at_rim_and_edge_only_if_wanted(density):
    rim, edge = 0.02, 5e-3
    problem = skin("rigid_bonded", "finite", support=fem.Support("hole", rim), density=density)
    halves = (fem.Discretisation(density, halved=True, edge=factor) for factor in (1.0, 2.0))
    own, beside, halved = (
        fem.prepare(replace(problem, discretisation=each)).mesh for each in (problem.discretisation, *halves)
    )
    for mesh, least, most in ((beside, 0.999, 1.001), (halved, 1.8, 3.5)):
        for place in (rim, edge):
            growth = next_to(mesh, place) / next_to(own, place)
            assert (least < growth).all()
            assert (growth < most).all()
        assert round_the(mesh, rim) == round_the(own, rim)
        assert mesh.elements.shape[1] < 0.7 * own.elements.shape[1]


def next_to(mesh, place):
    """Widths of the elements inside and outside a circle."""
    row = mesh.nodes[mesh.interfaces[0][::2], 0]
    at = int(np.abs(row - place).argmin())
    return np.array([row[at] - row[at - 1], row[at + 1] - row[at]])


def round_the(mesh, radius):
    """Nodes on a circle of the lower face."""
    return int((mesh.base & (np.abs(mesh.specimen_distance - radius) < 1e-9)).sum())


@pytest.mark.parametrize(
    ("words", "change"),
    [
        ("turn the specimen", lambda: skin(y=1e-3)),
        ("tool.tilt = 2 rad", lambda: fem.Tool(5e-3, "rigid_bonded", tilt=2.0)),
        ("use geometry = 'block'", lambda: skin(geometry="axisymmetric", x=1e-3)),
        ("only a tool of contact 'rigid_bonded'", lambda: skin(tilt=0.1)),
        ("geometry = 'ball'", lambda: skin(geometry="ball")),
        ("reaches the border", lambda: fem.prepare(skin(x=0.019, radius=0.02))),
        ("reaches the rim", lambda: fem.prepare(skin(x=0.017, support=fem.Support("hole", 0.02)))),
    ],
)
def test_what_does_not_fit_is_refused(words, change):
    with pytest.raises(fem.FemError, match=words):
        change()
