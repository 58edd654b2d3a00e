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


def rounds_until_limits_fit(pressure, most):
    """How many limits Coulomb's law takes until they are those that the pressure of each asks for."""
    friction = Friction(np.ones(6), np.zeros(6), np.zeros(6))
    for n in range(most):
        following = friction.following(pressure(friction.limit), 10.0)
        if following is None:
            return n, friction
        friction = following
    return most, friction


def test_limits_that_follow_the_pressure_slowly_are_found_in_few_rounds():
    """Two ways of the limits that shrink by 0.6 and 0.7 a round; one after the other they would take 45."""
    wanted = np.arange(1.0, 7.0)
    basis = np.linalg.qr(np.random.default_rng(0).standard_normal((6, 6)))[0][:, :2]
    rate = basis @ np.diag([0.6, -0.7]) @ basis.T
    rounds, friction = rounds_until_limits_fit(lambda limit: wanted + rate @ (limit - wanted), 60)
    assert rounds <= 6
    np.testing.assert_allclose(friction.limit, wanted, atol=1e-4)
    assert (friction.limit >= 0.0).all()


def test_limits_of_earlier_rounds_count_for_one_step_only():
    friction = Friction(np.ones(6), np.zeros(6), np.zeros(6)).following(np.ones(6), 10.0)
    assert len(friction.tried) == 1
    assert friction.after(np.zeros(6), np.zeros(6)).tried == ()
    assert friction.with_limit(np.ones(6)).tried == ()


def test_limits_are_never_negative_and_a_misfit_that_grows_begins_anew():
    friction = Friction(np.ones(2), np.array([1.0, 1.0]), np.zeros(2)).following(np.array([0.5, 1.0]), 10.0)
    further = friction.following(np.array([0.4, 1.0]), 10.0)
    assert (further.limit >= 0.0).all()
    assert len(further.tried) == 2
    anew = further.following(np.array([9.0, 1.0]), 10.0)
    assert len(anew.tried) == 1
    np.testing.assert_array_equal(anew.limit, [9.0, 1.0])
