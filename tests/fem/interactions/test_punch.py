"""The punch in three dimensions: its place, its gap and the gap's derivatives."""

import numpy as np
import pytest

from fem.interactions.punch import Punch, standing

TILT = np.radians(20.0)
STEP = 1e-5


def points(count=40):
    """Points round the edge, outside the punch."""
    rng = np.random.default_rng(7)
    angle, r = rng.uniform(0.0, 2 * np.pi, count), rng.uniform(0.5, 5.5, count)
    return np.stack((r * np.cos(angle), r * np.sin(angle), rng.uniform(-1.5, -0.5, count)))


def test_an_upright_punch_is_the_one_of_axial_symmetry():
    place = points()
    flat = Punch(5.0, 1.0).gap(np.stack((np.hypot(*place[:2]), place[2])))
    gap = standing(Punch(5.0, 1.0), (0.0, 0.0), 0.0).gap(place)
    np.testing.assert_allclose(gap.distance, flat.distance)
    np.testing.assert_allclose(np.hypot(*gap.path), flat.path[0])
    np.testing.assert_allclose(np.hypot(*gap.normal[:2]), np.abs(flat.normal[0]), atol=1e-14)
    np.testing.assert_allclose(gap.normal[2], flat.normal[1])


@pytest.mark.parametrize(("edge", "tilt"), [(1.0, 0.0), (1.0, TILT), (5.0, -TILT)])
def test_derivatives_of_the_gap(edge, tilt):
    punch, place = standing(Punch(5.0, edge), (0.3, 0.0), tilt), points()
    gap = punch.gap(place)
    full = np.empty((3, 3, place.shape[1]))
    i, j = np.triu_indices(3)
    full[i, j] = full[j, i] = gap.bend
    for axis, way in enumerate(STEP * np.eye(3)[:, :, None]):
        ahead, behind = punch.gap(place + way), punch.gap(place - way)
        np.testing.assert_allclose((ahead.distance - behind.distance) / (2 * STEP), gap.normal[axis], atol=1e-8)
        np.testing.assert_allclose((ahead.path - behind.path) / (2 * STEP), gap.along[:, axis], atol=1e-8)
        np.testing.assert_allclose((ahead.normal - behind.normal) / (2 * STEP), full[axis], atol=1e-7)


def test_the_tip_of_a_sphere_is_round():
    """On the axis, where no direction leads away from it, the sphere bends both ways."""
    gap = standing(Punch(5.0, 5.0), (0.0, 0.0), 0.0).gap(np.array([[0.0], [0.0], [-1.0]]))
    np.testing.assert_allclose(gap.normal[:, 0], [0.0, 0.0, -1.0], atol=1e-10)
    np.testing.assert_allclose(gap.bend[:, 0], [1 / 6, 0, 0, 1 / 6, 0, 0], atol=1e-10)
    np.testing.assert_allclose(gap.along[..., 0], [[5 / 6, 0, 0], [0, 5 / 6, 0]], atol=1e-10)


@pytest.mark.parametrize("tilt", [0.0, TILT, -TILT])
@pytest.mark.parametrize("edge", [1.0, 5.0])
def test_a_standing_punch_touches_the_plane_and_its_axis_meets_it_at_its_place(edge, tilt):
    punch = standing(Punch(5.0, edge), (2.0, 0.0), tilt)
    x = np.linspace(-6.0, 10.0, 4001)
    gap = punch.gap(np.stack((x, 0.0 * x, 0.0 * x))).distance
    assert gap.min() == pytest.approx(0.0, abs=1e-5)
    if edge < 5.0:
        assert np.sign(x[np.argmin(gap)] - 2.0) == np.sign(tilt) or tilt == 0.0
    foot_x, _, foot_z = punch.foot
    assert foot_x - foot_z * np.tan(tilt) == pytest.approx(2.0)


def test_a_lowered_punch_touches_the_first_point_only():
    place = points() - [[0.0], [0.0], [2.0]]
    gap = standing(Punch(5.0, 1.0), (0.0, 0.0), TILT).lowered(place).gap(place).distance
    assert gap.min() == pytest.approx(0.0, abs=1e-12)
    assert np.sort(gap)[1] > 1e-3


def test_the_metric_measures_lengths_on_the_punch():
    """On the surface itself, metric times derivative of the path keeps the length of every step along it."""
    punch = standing(Punch(5.0, 2.0), (0.0, 0.0), 0.0)
    turn, angle = np.array([0.0, 0.4, 1.2]), np.array([0.3, 1.0, 2.0])
    r = np.array([2.0, 0.0, 0.0]) + np.where(turn > 0, 3.0 + 2.0 * np.sin(turn), 0.0)
    place = np.stack((r * np.cos(angle), r * np.sin(angle), 2.0 - 2.0 * np.cos(turn)))
    gap = punch.gap(place)
    np.testing.assert_allclose(gap.distance, 0.0, atol=1e-14)
    along = np.einsum("abm,bim->aim", punch.metric(gap.path), gap.along)
    lengths = np.einsum("aim,bim->abm", along, along)
    np.testing.assert_allclose(lengths, np.repeat(np.eye(2)[..., None], 3, axis=2), atol=1e-12)
    assert np.abs(punch.metric(gap.path)[..., 2] - np.eye(2)).max() > 0.05
