"""Fans of elements at a singular point."""

import numpy as np
import pytest

from fem.assembly.axisymmetric import gauss_geometry, tabulate
from fem.mesh.fan import Fan
from fem.mesh.quads import build_mesh

LINES = np.array([0.0, 0.4, 0.8, 1.0, 1.2, 2.0])
DEPTHS = np.array([0.0, 0.6, 0.8, 1.0])
RIM = Fan(1.0, 0.2, (1.0, 0.5), depth=1.0, square_root=True)
CORNER = Fan(2.0, 0.8, (1.0, 0.5, 0.25))


def inner_elements(mesh, fan):
    at_point = np.isclose(mesh.nodes, fan.point, rtol=0.0, atol=1e-12).all(axis=1)
    return np.flatnonzero(at_point[mesh.elements[:4]].sum(axis=0) == 2)


@pytest.mark.parametrize("fans", [[RIM], [CORNER], [Fan(1.0, 0.2, (1.0,), depth=1.0)]], ids=["rim", "corner", "plain"])
def test_fans_on_both_faces_fill_their_boxes(fans):
    depths = np.array([0.0, 0.8, 1.0])
    weight = gauss_geometry(build_mesh(LINES, depths, np.zeros(1), fans)).weight
    assert (weight > 0.0).all()
    assert weight.sum() == pytest.approx(4.0 * np.pi, rel=1e-13)


def test_the_innermost_elements_hold_the_square_root_of_the_distance():
    mesh = build_mesh(LINES, DEPTHS, np.zeros(1), [RIM])
    elements = inner_elements(mesh, RIM)
    assert len(elements) == 4
    along = np.stack((np.full(9, 0.5), np.linspace(0.0, 1.0, 9)))
    for points in (along, along[::-1]):
        shapes = tabulate(points).radial.reshape(3, 9, 9)[2]
        for element in mesh.elements[:, elements].T:
            distance = np.linalg.norm(mesh.nodes[element] - RIM.point, axis=1)
            at = np.linalg.norm(shapes @ mesh.nodes[element] - RIM.point, axis=1)
            if at.min() > 1e-9:
                continue  # across the rays
            np.testing.assert_allclose(shapes @ np.sqrt(distance), np.sqrt(at), atol=1e-9)


def test_a_fan_leaves_the_nodes_beyond_its_innermost_elements():
    plain = build_mesh(LINES, DEPTHS, np.zeros(1), [Fan(1.0, 0.2, (1.0, 0.5), depth=1.0)])
    drawn = build_mesh(LINES, DEPTHS, np.zeros(1), [RIM])
    np.testing.assert_array_equal(plain.elements, drawn.elements)
    moved = (plain.nodes != drawn.nodes).any(axis=1)
    inner = plain.elements[:, inner_elements(plain, RIM)]
    assert moved.sum() == 9  # five rays and four middles
    assert np.isin(np.flatnonzero(moved), inner).all()
    assert plain.base.sum() == drawn.base.sum()
