from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.setup.layout import lay_out


def elements_at_edge(mesh, radius):
    """Elements that have a corner at the tool's edge."""
    at_edge = (mesh.nodes == [radius, 0.0]).all(axis=1)
    return int(at_edge[mesh.elements[:4]].any(axis=0).sum())


def test_the_edge_of_a_stuck_tool_on_a_thick_layer_has_a_fan(slab):
    assert elements_at_edge(lay_out(slab("rigid_bonded")), 5e-3) == 8


@pytest.mark.parametrize(("contact", "kinematics"), [("uniform_pressure", "finite"), ("rigid_bonded", "linear")])
def test_other_edges_are_graded_only(slab, contact, kinematics):
    assert elements_at_edge(lay_out(slab(contact, kinematics)), 5e-3) == 2


def test_a_thin_first_layer_has_no_room_for_a_fan(skin):
    assert elements_at_edge(lay_out(skin("rigid_bonded")), 5e-3) == 2


def test_a_hole_as_wide_as_the_tool_gets_no_fan(slab):
    mesh = lay_out(slab("rigid_bonded", support=fem.Support("hole", 5.2e-3)))
    assert elements_at_edge(mesh, 5e-3) == 2
    assert (mesh.nodes[:, 0] == 5.2e-3).any()


@pytest.mark.parametrize("first", [0.4e-3, 0.6e-3, 0.9e-3, 1.1e-3])
def test_the_fan_respects_the_first_interface(first):
    layers = tuple(
        fem.Layer(name, thickness, 1000.0, fem.NeoHookean(2e4, 0.48)) for name, thickness in (("a", first), ("b", 5e-3))
    )
    mesh = lay_out(fem.Problem(layers, fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded")))
    depth = -mesh.nodes[mesh.elements[:4], 1]
    assert (depth[:, mesh.layer == 0] <= first * (1 + 1e-12)).all()
    assert (depth[:, mesh.layer == 1] >= first * (1 - 1e-12)).all()


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_fine_has_about_four_times_the_elements(skin, contact):
    count = {
        density: lay_out(skin(contact, discretisation=fem.Discretisation(density))).elements.shape[1]
        for density in ("coarse", "default", "fine")
    }
    assert count["coarse"] < count["default"]
    assert count["fine"] == 4 * count["default"]


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e3])
def test_meshes_of_all_sizes_are_alike(scale):
    layer = fem.Layer("a", 3.0 * scale, 1000.0, fem.NeoHookean(2e4, 0.48))
    mesh = lay_out(fem.Problem((layer,), fem.Tool(scale, "rigid_bonded"), fem.Support("bonded")))
    unit = lay_out(
        fem.Problem(
            (fem.Layer("a", 3.0, 1000.0, layer.material),), fem.Tool(1.0, "rigid_bonded"), fem.Support("bonded")
        )
    )
    np.testing.assert_allclose(mesh.nodes, scale * unit.nodes, rtol=1e-9, atol=1e-12 * scale)


def test_elements_at_a_stuck_edge_are_larger_on_request(slab, skin):
    def size(problem, edge):
        wider = replace(problem, discretisation=replace(problem.discretisation, edge=edge))
        mesh = lay_out(wider)
        at_edge = (mesh.nodes == [5e-3, 0.0]).all(axis=1)
        corners = mesh.nodes[mesh.elements[:4, at_edge[mesh.elements[:4]].any(axis=0)], 0]
        return np.ptp(corners)

    sizes = [size(slab("rigid_bonded"), edge) for edge in (1.0, 2.0, 4.0)]
    assert sizes[1] > 1.4 * sizes[0]
    assert sizes[2] > 1.4 * sizes[1]
    assert size(slab("rigid_bonded"), 8.0) > 1.4 * sizes[2]
    for other in (slab("uniform_pressure"), skin("rigid_bonded")):
        assert size(other, 4.0) == size(other, 1.0)


@pytest.mark.parametrize("first", [4e-3, 7e-3, 20e-3])
def test_the_largest_fan_stays_off_the_axis(first):
    layer = fem.Layer("a", first, 1000.0, fem.NeoHookean(2e4, 0.48))
    for support in (fem.Support("bonded"), fem.Support("hole", 0.03)):
        problem = fem.Problem(
            (layer,), fem.Tool(5e-3, "rigid_bonded"), support, discretisation=fem.Discretisation(edge=4)
        )
        mesh = lay_out(problem)
        assert mesh.nodes[:, 0].min() == 0.0
        assert fem.prepare(problem).run(fem.Load("force", [1.0], [0.01])).complete
