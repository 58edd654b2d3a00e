import numpy as np
import pytest

from fem.mesh.solid import DiscGrid

RINGS = np.array([0.4, 0.7, 1.0, 2.0, 4.0])


def grid(quarters=1, centre=0.0):
    return DiscGrid(RINGS, 2, quarters, centre, tool_radius=1.0, centred_from=4.0, round_to=1.0)


def areas(plane):
    """Signed area of the bilinear corners of each element."""
    points, patches = plane.points(), plane.elements()
    x, y = points[patches[[0, 2, 2, 0], [0, 0, 2, 2]]].transpose(2, 0, 1)
    return 0.5 * ((x[2] - x[0]) * (y[3] - y[1]) - (x[3] - x[1]) * (y[2] - y[0]))


@pytest.mark.parametrize(("quarters", "centre"), [(1, 0.0), (2, 0.0), (2, 1.5)])
def test_the_grid_fills_the_square_without_folds(quarters, centre):
    found = areas(grid(quarters, centre))
    assert (found > 0.0).all()
    assert found.sum() == pytest.approx(quarters * 16.0, rel=1e-12)


@pytest.mark.parametrize("centre", [0.0, 1.5])
def test_a_ring_of_nodes_follows_the_tool(centre):
    distance = np.hypot(*(grid(2, centre).points() - [centre, 0.0]).T)
    assert (np.abs(distance - 1.0) < 1e-12).sum() == 17


def test_each_node_is_used_once_a_place():
    plane = grid(2, 0.5)
    points = plane.points()
    assert len(np.unique(np.round(points, 9), axis=0)) == len(points)
    np.testing.assert_array_equal(np.unique(plane.elements()), np.arange(len(points)))


def test_the_row_goes_from_the_axis_to_the_border():
    row = grid(2, 0.5).points()[grid(2, 0.5).row()]
    np.testing.assert_array_equal(row[:, 1], 0.0)
    assert row[0, 0] == 0.5
    assert row[-1, 0] == pytest.approx(4.0)
    assert (np.diff(row[:, 0]) > 0.0).all()
