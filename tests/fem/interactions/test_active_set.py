"""Friction with a given limit, in one and two directions."""

import numpy as np
import pytest

from fem.interactions.active_set import Friction

K = np.array([2.0, 2.0, 2.0])


def dragged(multiplier, slid, limit, k):
    return Friction(k, limit, np.zeros_like(slid)).multiplier_drag(multiplier, slid)


@pytest.mark.parametrize("directions", [1, 2])
def test_a_node_sticks_below_its_limit_and_slides_above_it(directions):
    slid = np.zeros((directions, 3))
    slid[-1] = [0.1, 0.1, -0.1]
    multiplier, limit = slid.copy(), np.array([1.0, 0.1, 0.0])
    found = dragged(multiplier, slid, limit, K)
    np.testing.assert_array_equal(found.sticks, [True, False, False])
    np.testing.assert_allclose(found.force[-1], [0.2, 0.1, 0.0])
    np.testing.assert_allclose(found.left[-1], [0.0, 0.1 - 0.2, 0.2])


def test_the_drag_of_a_sliding_node_lies_along_its_slip():
    way, limit = np.array([[3.0], [4.0]]), np.array([0.5])
    multiplier = limit / K[:1] * way / 5.0
    found = dragged(multiplier, way, limit, K[:1])
    np.testing.assert_allclose(found.force, 0.5 * way / 5.0)
    np.testing.assert_allclose(found.left, 0.0, atol=1e-15)


def test_its_derivative_is_that_of_the_slip_where_the_multiplier_fits():
    way, limit, k, step = np.array([[3.0], [4.0]]), np.array([0.5]), K[:1], 1e-6
    multiplier = limit / k * way / 5.0
    found = dragged(multiplier, way, limit, k)
    for axis, more in enumerate(step * np.eye(2)[:, :, None]):
        change = (dragged(multiplier, way + more, limit, k).force - dragged(multiplier, way - more, limit, k).force) / (
            2 * step
        )
        np.testing.assert_allclose(found.turning[:, axis], change, atol=1e-8)


def test_a_multiplier_that_points_elsewhere_makes_it_stiffer():
    way, limit, k = np.array([[5.0], [0.0]]), np.array([0.5]), K[:1]
    least = []
    for angle in (0.0, np.pi / 4):
        found = dragged(limit / k * np.array([[np.cos(angle)], [np.sin(angle)]]), way, limit, k)
        assert not found.sticks[0]
        least.append(np.linalg.eigvalsh(found.turning[..., 0]).min())
    assert least[0] == pytest.approx(0.0, abs=1e-12)
    assert least[1] > 0.01
