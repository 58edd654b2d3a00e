"""Rows of nodes and interfaces whose sides are parted."""

import numpy as np
import pytest

from fem.assembly.axisymmetric import gauss_geometry
from fem.mesh.fan import Fan
from fem.mesh.quads import along_row, build_mesh, ring_areas, split_interfaces

WHOLE = build_mesh(np.array([0.0, 1.0, 3.0]), np.array([0.0, 1.0, 2.0, 4.0]), np.array([0.0, 1.0, 2.0]))


def test_sides_coincide_and_share_axis_and_border():
    parted = split_interfaces(WHOLE, (0, 1))
    for upper, lower in zip(parted.undersides, parted.interfaces[1:], strict=True):
        np.testing.assert_array_equal(parted.nodes[upper], parted.nodes[lower])
        np.testing.assert_array_equal(upper == lower, [True, False, False, False, True])


def test_each_side_belongs_to_its_layer():
    parted = split_interfaces(WHOLE, (0, 1))
    for layer in range(2):
        upper, lower = parted.undersides[layer][1:-1], parted.interfaces[layer + 1][1:-1]
        of_layer = [set(parted.elements[:, parted.layer == n].ravel().tolist()) for n in range(3)]
        assert set(upper.tolist()) <= of_layer[layer]
        assert set(lower.tolist()) <= of_layer[layer + 1]
        assert not of_layer[layer] & set(lower.tolist())
        assert not of_layer[layer + 1] & set(upper.tolist())


def test_nothing_else_changes():
    parted = split_interfaces(WHOLE, (1,))
    assert len(parted.nodes) == len(WHOLE.nodes) + 3
    np.testing.assert_array_equal(parted.nodes[parted.elements], WHOLE.nodes[WHOLE.elements])
    np.testing.assert_array_equal(parted.undersides[0], WHOLE.interfaces[1])
    assert split_interfaces(WHOLE, ()) is WHOLE


@pytest.mark.parametrize("middle", [0.25, 0.4, 0.5, 0.75])
def test_a_row_is_interpolated_by_its_elements_own_places(middle):
    """Values that are quadratic in the element's coordinate s, along places 1 + (4 m - 1) s + 2 (1 - 2 m) s^2."""
    s = np.linspace(0.0, 1.0, 21)
    value = 2.0 - s + 3.0 * s**2
    place = np.array([0.0, 0.5, 1.0, 1.0 + middle, 2.0])
    nodal = np.array([0.0, 1.0, value[0], value[10], value[-1]])
    found = along_row(place, nodal, 1.0 + (4.0 * middle - 1.0) * s + 2.0 * (1.0 - 2.0 * middle) * s**2)
    np.testing.assert_allclose(found, value, rtol=1e-12)
    np.testing.assert_allclose(along_row(place, nodal, place), nodal, rtol=1e-12)


def test_quarter_points_hold_the_square_root():
    r, place = np.linspace(0.0, 4.0, 33), np.array([0.0, 1.0, 4.0])
    np.testing.assert_allclose(along_row(place, np.sqrt(place), r), np.sqrt(r), atol=1e-12)


def test_ring_areas_fill_the_ring():
    r = np.array([1.0, 2.0, 3.0, 3.5, 4.0])
    area = ring_areas(r)
    assert area.sum() == pytest.approx(np.pi * (4.0**2 - 1.0**2))
    assert area @ r == pytest.approx(2.0 * np.pi * (4.0**3 - 1.0**3) / 3.0)


R_LINES = np.array([0.0, 0.4, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0, 3.0])
DEPTHS = np.array([0.0, 0.1, 0.2, 0.6, 1.0, 2.0])
TOPS = np.array([0.0, 0.6])
FAN = Fan(1.0, 0.2, (1.0, 0.5))


@pytest.fixture(params=[(), (FAN,)], ids=["graded", "fan"])
def mesh(request):
    return build_mesh(R_LINES, DEPTHS, TOPS, request.param)


def test_elements_fill_the_cylinder(mesh):
    weight = gauss_geometry(mesh).weight
    assert (weight > 0.0).all()
    assert weight.sum() == pytest.approx(np.pi * 9.0 * 2.0, rel=1e-13)


def test_layers_have_their_volumes(mesh):
    weight = gauss_geometry(mesh).weight.sum(axis=0)
    assert weight[mesh.layer == 0].sum() == pytest.approx(np.pi * 9.0 * 0.6, rel=1e-13)


def test_interfaces_are_rows_of_corners_and_middles(mesh):
    for row, depth in zip(mesh.interfaces, TOPS, strict=True):
        r, z = mesh.nodes[row].T
        assert (z == -depth).all()
        assert r[0] == 0.0
        assert r[-1] == 3.0
        np.testing.assert_allclose(r[1::2], 0.5 * (r[:-2:2] + r[2::2]), rtol=1e-14)


def test_node_sets_lie_on_their_lines(mesh):
    r, z = mesh.nodes.T
    assert (r[mesh.axis] == 0.0).all()
    assert (r[mesh.border] == 3.0).all()
    assert (z[mesh.base] == -2.0).all()
    assert (z[mesh.top] == 0.0).all()
    assert mesh.axis.sum() == 2 * (len(DEPTHS) - 1) + 1
    assert mesh.radius == 3.0


def test_the_fan_shares_the_half_turn_among_its_rays():
    mesh = build_mesh(R_LINES, DEPTHS, TOPS, [FAN])
    at_edge = (mesh.nodes[mesh.elements[2]] == [1.0, 0.0]).all(axis=1) & (
        mesh.nodes[mesh.elements[3]] == [1.0, 0.0]
    ).all(axis=1)
    assert at_edge.sum() == 8
    arms = mesh.nodes[mesh.elements[:2, at_edge]] - [1.0, 0.0]
    angle = np.arctan2(arms[..., 1], arms[..., 0])
    turn = np.abs(np.diff(np.unwrap(angle, axis=0), axis=0))
    assert turn.sum() == pytest.approx(np.pi)
    assert turn.max() < np.pi / 5
