from dataclasses import replace

import numpy as np
import pytest
import pyvista

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


def box(shift=(0.0, 0.0, 0.0)):
    """A cube of 10 mm, its walls triangulated unevenly, turned about two axes."""
    cube = pyvista.Box((0.0, 1.0, 0.0, 1.0, 0.0, 1.0)).triangulate().subdivide(2, "linear").clean()
    points = np.asarray(cube.points, dtype=np.float64)
    inside = (points > 0.0) & (points < 1.0)
    points += 0.06 * inside * np.random.default_rng(3).uniform(-1.0, 1.0, points.shape) + np.asarray(shift)
    c, s = np.cos(0.1), np.sin(0.1)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.array(
        [[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]
    )
    return Surface(0.01 * points @ turn.T, cube.regular_faces.astype(np.int64))


def joined(one, other):
    triangles = np.concatenate((one.triangles, other.triangles + len(one.points)))
    return Surface(np.concatenate((one.points, other.points)), triangles)


@pytest.mark.parametrize("moved", [0.0, 1.0])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_flat_walls_of_many_triangles_do_not_cross(kind, moved):
    flat = box()
    points = (flat.points + moved).astype(kind).astype(np.float64)
    assert check_surface(replace(flat, points=points)).remarks == ()


def test_a_wall_folded_flat_says_where():
    """A point of a wall is moved within it, over its neighbours."""
    cube = pyvista.Box((0.0, 0.01, 0.0, 0.01, 0.0, 0.01)).triangulate().subdivide(2, "linear").clean()
    points = np.asarray(cube.points, dtype=np.float64)
    moved = np.linalg.norm(points - [0.005, 0.005, 0.0], axis=1).argmin()
    points[moved, :2] += 0.004
    with pytest.raises(FemError, match=r"touches itself or is folded flat near \(0\.00"):
        check_surface(Surface(points, cube.regular_faces.astype(np.int64)))


def test_faces_that_touch_say_where_and_what_is_allowed():
    with pytest.raises(
        FemError, match=r"touches itself or is folded flat near \(.* m; allowed are faces further apart"
    ):
        check_surface(joined(box(), box((1.0, 0.2, 0.1))))


def test_a_second_shell_is_refused_with_volumes_and_places(ball):
    small = Surface(0.3 * ball.points + [0.04, 0.0, 0.0], ball.triangles)
    words = r"has 2 shells: 32.38 cm3 round \(.*\) m, 0.8742 cm3 round \(0.04, .*allowed is one closed shell"
    with pytest.raises(FemError, match=words):
        check_surface(joined(ball, small))


def test_a_shell_within_must_look_into_a_hollow(ball):
    hollow = Surface(0.3 * ball.points, ball.triangles[:, ::-1])
    assert check_surface(joined(ball, hollow)).volume == pytest.approx((1.0 - 0.3**3) * ball.volume)
    for other in (replace(hollow, triangles=ball.triangles), replace(hollow, points=hollow.points + 0.05)):
        with pytest.raises(FemError, match="has 2 shells"):
            check_surface(joined(ball, other))
