from dataclasses import replace

import numpy as np
import pytest

from fem import FemError
from fem.mesh.surface.checking import check_surface
from fem.mesh.surface.surface_file import Surface


def test_a_good_surface_stays_as_it_is(ball):
    checked = check_surface(ball)
    assert checked.remarks == ()
    np.testing.assert_array_equal(checked.triangles, ball.triangles)


def test_an_inverted_surface_is_turned_and_says_so(ball):
    turned = check_surface(replace(ball, triangles=ball.triangles[:, ::-1]))
    assert turned.volume == pytest.approx(ball.volume)
    assert turned.remarks == ("the surface looked inwards and was turned",)


def test_a_small_hole_is_filled_and_says_where(ball):
    small = subdivided(ball)
    filled = check_surface(replace(small, triangles=np.delete(small.triangles, 7, axis=0)))
    assert filled.volume == pytest.approx(small.volume, rel=1e-6)
    (remark,) = filled.remarks
    assert remark.startswith("a hole of 3 edges near (")


def subdivided(surface):
    """Each triangle in four, twice."""
    for _ in range(2):
        corners = surface.corners
        middle = 0.5 * (corners + np.roll(corners, -1, axis=1))
        a, b, c = corners.transpose(1, 0, 2)
        d, e, f = middle.transpose(1, 0, 2)
        soup = np.concatenate([np.stack(t, axis=1) for t in ((a, d, f), (d, b, e), (f, e, c), (d, e, f))]).reshape(
            -1, 3
        )
        points, index = np.unique(np.round(soup, 12), axis=0, return_inverse=True)
        surface = Surface(points, index.reshape(-1, 3))
    return surface


def test_an_open_surface_says_where(ball):
    cap = ball.corners.mean(axis=1)[:, 2] > 0.012
    with pytest.raises(FemError, match=r"is open near \(.*0\.01\d+\) m"):
        check_surface(replace(ball, triangles=ball.triangles[~cap]))


def test_a_surface_through_itself_says_where(ball):
    points = np.concatenate((ball.points, ball.points + np.array([0.02, 0.0, 0.0])))
    both = Surface(points, np.concatenate((ball.triangles, ball.triangles + len(ball.points))))
    with pytest.raises(FemError, match=r"crosses itself near \(0\.0"):
        check_surface(both)


def test_neighbours_that_look_to_opposite_sides_are_refused(ball):
    twisted = ball.triangles.copy()
    twisted[5] = twisted[5, ::-1]
    with pytest.raises(FemError, match="look to opposite sides"):
        check_surface(replace(ball, triangles=twisted))


def test_three_triangles_at_an_edge_are_refused(ball):
    a, b = ball.triangles[0, :2]
    points = np.concatenate((ball.points, [[0.05, 0.0, 0.0]]))
    fin = np.array([[a, b, len(ball.points)], [b, a, len(ball.points)]])
    with pytest.raises(FemError, match="triangles meet at one edge"):
        check_surface(Surface(points, np.concatenate((ball.triangles, fin))))


@pytest.mark.parametrize("factor", [1e3, 1e-3])
def test_a_wrong_unit_is_asked_about(ball, factor):
    with pytest.raises(FemError, match="is the unit right"):
        check_surface(replace(ball, points=factor * ball.points))


def test_no_triangles_and_no_numbers_are_refused(ball):
    with pytest.raises(FemError, match="has 0 triangles"):
        check_surface(replace(ball, triangles=ball.triangles[:0]))
    points = ball.points.copy()
    points[3, 1] = np.nan
    with pytest.raises(FemError, match="point 3 has a coordinate that is not finite"):
        check_surface(replace(ball, points=points))
