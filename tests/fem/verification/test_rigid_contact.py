"""Forces of a rigid surface on nodes: their derivative, which facet is met, and when multipliers settle."""

from dataclasses import replace

import numpy as np
import pytest

from fem.verification.rigid_contact import Augmentation, RigidContact, RigidFacets, RigidPlane, nodal_area

ROOF = (
    np.array([[0.0, 0, 0], [1, 0, 1], [1, 2, 1], [0, 2, 0]]),
    np.array([[1.0, 0, 1], [2, 0, 0], [2, 2, 0], [1, 2, 1]]),
)
TRIANGLE = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]),)


def contact(surface, augmentation=None):
    rng = np.random.default_rng(3)
    places = rng.uniform(0.2, 1.8, (5, 3)) * [1.0, 1.0, 0.3]
    return RigidContact(np.arange(1, 6), places, rng.uniform(1, 2, 5), rng.uniform(3, 4, 5), surface, augmentation)


@pytest.mark.parametrize(
    "surface",
    [
        pytest.param(RigidPlane(np.array([0.2, -0.3, 2.0, 0.6]), 0.3), id="plane"),
        pytest.param(RigidFacets(ROOF, np.array([0.1, 0.0, 0.2]), 0.01), id="facets"),
    ],
)
def test_the_stiffness_is_the_derivative_of_the_force(surface):
    one, rng = contact(surface), np.random.default_rng(4)
    u, way, multiplier = 0.01 * rng.standard_normal((3, 8)), rng.standard_normal((3, 8)), rng.uniform(0, 1, 5)
    there, back = (one.touch(u + step * way, 0.7, multiplier).force for step in (1e-6, -1e-6))
    found = one.touch(u, 0.7, multiplier)
    assert (found.pressure > 0.0).any()
    np.testing.assert_allclose((back - there) / 2e-6, found.stiffness @ way.ravel(), atol=1e-7)


def test_a_plane_is_as_far_as_its_unit_vector_says():
    depth, normal, slope = RigidPlane(np.array([0.0, 0, 1, 2]), 0.5).gap(np.array([[3.0, 1, 1.8]]), 0.4)
    assert depth == pytest.approx([0.4])
    np.testing.assert_array_equal(normal, [[0, 0, 1]])
    assert slope == 1.0


def test_the_nearest_facet_under_a_node_is_met_and_beside_them_none():
    places = np.array([[0.5, 1.0, 0.4], [1.6, 1.0, 0.3], [1.0, 2.5, 0.5], [0.5, 2.01, 0.4]])
    depth, normal, _ = RigidFacets(ROOF, np.zeros(3), 0.02).gap(places, 1.0)
    assert depth == pytest.approx([0.1 / np.sqrt(2), 0.1 / np.sqrt(2), -np.inf, 0.1 / np.sqrt(2)])
    np.testing.assert_allclose(normal[:2], np.array([[-1, 0, 1], [1, 0, 1]]) / np.sqrt(2), atol=1e-15)


def test_a_triangle_has_its_margin_in_its_own_coordinates():
    facets = RigidFacets(TRIANGLE, np.array([0.0, 0, 1.0]), 0.01)
    depth, _, _ = facets.gap(np.array([[-0.009, 0.2, 0.0], [-0.011, 0.2, 0.0]]), 0.5)
    assert depth == pytest.approx([0.5, -np.inf])


@pytest.mark.parametrize(
    ("corners", "area"),
    [([[0, 0, 0], [2, 0, 0], [1, 1, 0], [0, 1, 0]], 1.5), ([[0, 0, 0], [0, 2, 0], [0, 0, 3]], 3.0)],
)
def test_corners_share_a_facet_s_area(corners, area):
    assert nodal_area(np.array(corners, dtype=float)).sum() == pytest.approx(area)


def test_multipliers_settle_by_their_change_within_the_least_and_the_most_times():
    plane = RigidPlane(np.array([0.0, 0, 1, 0]), 0.0)
    before, after = np.array([3.0, 4.0]), np.array([3.3, 4.4])
    one = contact(plane, Augmentation(0.05, 1, 4))
    assert [one.settled(before, after, times) for times in (0, 3, 4)] == [False, False, True]
    assert [one.settled(after, after, times) for times in (0, 1)] == [False, True]
    assert replace(one, augmentation=None).settled(before, after, 0)
    assert not one.exact.settled(before, after, 10)
