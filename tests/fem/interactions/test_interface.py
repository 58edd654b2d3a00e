"""The curve of one side of an interface, and the nodes of the other that slip along it."""

from dataclasses import replace

import numpy as np
import pytest

from fem.interactions.active_set import Friction
from fem.interactions.interface import Curve, InterfaceFriction

RADIUS = np.array([0.0, 0.3, 0.6, 1.0, 1.5, 2.2, 3.0, 3.5, 4.0])
PLACES = np.array([0.0, 0.1, 0.45, 2.0, 3.2, 4.0])


def test_at_the_nodes_it_is_their_displacement():
    value = Curve(RADIUS).weights(RADIUS)[0]
    np.testing.assert_allclose(value, np.broadcast_to(np.eye(len(RADIUS)), value.shape), atol=1e-12)


def test_a_radial_stretch_and_a_vertical_shift_are_exact():
    weights = Curve(RADIUS).weights(PLACES)
    np.testing.assert_allclose(weights[:, 0] @ RADIUS, [PLACES, np.ones(6), np.zeros(6)], atol=1e-12)
    np.testing.assert_allclose(weights[:, 1].sum(axis=-1), [np.ones(6), np.zeros(6), np.zeros(6)], atol=1e-12)


def test_derivatives_are_those_of_the_value_also_across_nodes():
    curve, step, places = Curve(RADIUS), 1e-5, np.array([0.2, 0.6, 1.0, 2.5, 3.5])
    below, at, above = (curve.weights(places + shift) for shift in (-step, 0.0, step))
    np.testing.assert_allclose((above - below)[:2] / (2 * step), at[1:], atol=1e-3)


def test_it_nears_a_smooth_bowl_by_the_fourth_order():
    def error(count):
        radius = np.linspace(0.0, 4.0, count)
        places = np.linspace(0.0, 2.0, 101)
        bowl = Curve(radius).weights(places)[0, 1] @ np.exp(-(radius**2))
        return np.abs(bowl - np.exp(-(places**2))).max()

    assert np.log2(error(17) / error(33)) > 3.5


@pytest.mark.parametrize("beyond", [-1e-3, 4.001])
def test_beyond_its_ends_there_is_none(beyond):
    assert Curve(RADIUS).weights(np.array([1.0, beyond])) is None


NODES = np.array([0.0, 0.3, 0.6, 1.0, 1.5, 2.2, 3.0])
COUNT = len(NODES) - 2
GIVE = 1e-2
SIZE = 5 * COUNT + 2 * len(NODES)


def interface(limit):
    along = 5 * COUNT + np.arange(2 * len(NODES)).reshape(2, -1)
    along[0, 0] = -1
    along[:, -1] = -1
    own = np.arange(5 * COUNT).reshape(5, COUNT)
    hold = np.linspace(1.0, 3.0, COUNT)
    friction = Friction(hold / GIVE, np.full(COUNT, limit), np.zeros(COUNT))
    return InterfaceFriction(Curve(NODES), NODES[1:-1], own, along, hold, GIVE, friction)


def balance(part, y):
    residual = np.zeros(SIZE)
    np.add.at(residual, part.unknowns, part.respond(y).force)
    return residual


def matrix(part, y):
    rows, columns = part.entries
    full = np.zeros((SIZE, SIZE))
    np.add.at(full, (rows, columns), part.respond(y).stiffness)
    return full + full.T - np.diag(full.diagonal())


@pytest.mark.parametrize("limit", [0.0, 1e9])
def test_the_stiffness_is_the_derivative_of_the_forces(limit):
    part, y, step = interface(limit), 0.1 * np.random.default_rng(0).normal(size=SIZE), 1e-6
    slope = [(balance(part, y + step * e) - balance(part, y - step * e)) / (2 * step) for e in np.eye(SIZE)]
    np.testing.assert_allclose(matrix(part, y), np.array(slope).T, atol=1e-7)


def test_what_holds_a_node_pushes_the_curve_back():
    y = 0.1 * np.random.default_rng(1).normal(size=SIZE)
    part = interface(1.0)
    found = part.evaluate(y)
    assert found.force[1].sum() + found.curve_force[1].sum() == pytest.approx(0.0, abs=1e-12)
    assert part.respond(y).support == pytest.approx(found.curve_force[1, -1])


def state(pull, slip, stretch=1.0):
    """Unknowns of a curve stretched radially, all nodes slid and held by a force along it."""
    y = np.zeros(SIZE + 1)
    part = interface(1.0)
    y[part.along[0]] = (stretch - 1.0) * NODES
    y[part.own[4]], y[part.own[2]] = slip, pull / part.hold
    return y[:-1]


def test_it_sticks_below_the_limit_and_slides_at_it():
    part = interface(1.0)
    np.testing.assert_allclose(part.evaluate(state(0.5, 1e-3)).friction, 1e-3 * part.hold / part.give)
    np.testing.assert_allclose(part.evaluate(state(1.5, 1e-3)).friction, 1.0)
    np.testing.assert_allclose(part.evaluate(state(-1.5, -1e-3)).friction, -1.0)
    assert not interface(0.0).evaluate(state(0.5, 1e-3)).friction.any()


def test_the_limit_holds_along_the_stretched_curve():
    """The work of the friction is its force along the curve times the stretched slip."""
    free = replace(interface(1.0), along=5 * COUNT + np.arange(2 * len(NODES)).reshape(2, -1))
    y = np.zeros(SIZE)
    y[free.along[0]], y[free.own[2]] = 0.25 * NODES, 5.0
    found = free.evaluate(y)
    np.testing.assert_allclose(found.stretch, 1.25)
    np.testing.assert_allclose(found.friction, 1.25)


def test_after_a_slip_it_sticks_where_it_came_to():
    part = interface(1.0)
    later = part.accepted(state(1.5, 0.1))
    np.testing.assert_allclose(later.friction.anchor, 0.1 - part.give / part.hold)
    np.testing.assert_allclose(later.evaluate(state(1.0, 0.1)).friction, 1.0)
    assert part.remembers
    assert not interface(0.0).remembers


def test_beyond_the_end_of_the_curve_there_is_none():
    assert interface(1.0).evaluate(state(0.0, 1.0)) is None


def test_slips_are_found_from_where_the_nodes_are():
    part, rng = interface(1.0), np.random.default_rng(3)
    y, slip = np.zeros(SIZE + 1), 0.05 * rng.normal(size=COUNT)
    y[part.along] = 0.05 * rng.normal(size=part.along.shape)
    y[-1] = 0.0
    weights = part.curve.weights(part.start + slip)
    y[part.own[0]] = slip + weights[0, 0] @ y[part.along[0]]
    np.testing.assert_allclose(part.met(y[:-1])[part.own[4]], slip, atol=1e-9)
    np.testing.assert_allclose(part.led(part.met(y[:-1])).friction.anchor, slip, atol=2.0 * GIVE)
    beyond = np.where(np.isin(np.arange(SIZE), part.own[0]), 99.0, y[:-1])
    np.testing.assert_array_equal(part.met(beyond), beyond)
