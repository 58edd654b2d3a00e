from dataclasses import replace

import numpy as np
import pytest

from fem.assembly.curve import Curve
from fem.assembly.slipping import Slipping

RADIUS = np.array([0.0, 0.3, 0.6, 1.0, 1.5, 2.2, 3.0])
COUNT = len(RADIUS) - 2
SIZE = 5 * COUNT + 2 * len(RADIUS)


def interface(limit):
    along = 5 * COUNT + np.arange(2 * len(RADIUS)).reshape(2, -1)
    along[0, 0] = -1
    along[:, -1] = -1
    own = np.arange(5 * COUNT).reshape(5, COUNT)
    hold = np.linspace(1.0, 3.0, COUNT)
    return Slipping(Curve(RADIUS), RADIUS[1:-1], own, along, hold, 1e-2, np.full(COUNT, limit), np.zeros(COUNT))


def balance(part, y):
    residual = np.zeros(SIZE)
    part.add_force(part.grip(y), residual)
    return residual


def matrix(part, y):
    rows, columns = part.entries
    full = np.zeros((SIZE, SIZE))
    np.add.at(full, (rows, columns), part.values(part.grip(y)))
    return full + full.T - np.diag(full.diagonal())


@pytest.mark.parametrize("limit", [0.0, 1e9])
def test_the_stiffness_is_the_derivative_of_the_forces(limit):
    part, y, step = interface(limit), 0.1 * np.random.default_rng(0).normal(size=SIZE), 1e-6
    slope = [(balance(part, y + step * e) - balance(part, y - step * e)) / (2 * step) for e in np.eye(SIZE)]
    np.testing.assert_allclose(matrix(part, y), np.array(slope).T, atol=1e-7)


def test_what_holds_a_node_pushes_the_curve_back():
    y = 0.1 * np.random.default_rng(1).normal(size=SIZE)
    part = interface(1.0)
    grip = part.grip(y)
    assert grip.force[1].sum() + grip.curve_force[1].sum() == pytest.approx(0.0, abs=1e-12)
    assert part.on_fixed(grip) == pytest.approx(grip.curve_force[1, -1])


def state(pull, slip, stretch=1.0):
    """Unknowns of a curve stretched radially, all nodes slid and held by a force along it."""
    y = np.zeros(SIZE + 1)
    part = interface(1.0)
    y[part.along[0]] = (stretch - 1.0) * RADIUS
    y[part.own[4]], y[part.own[2]] = slip, pull / part.hold
    return y[:-1]


def test_it_sticks_below_the_limit_and_slides_at_it():
    part = interface(1.0)
    np.testing.assert_allclose(part.grip(state(0.5, 1e-3)).friction, 1e-3 * part.hold / part.give)
    np.testing.assert_allclose(part.grip(state(1.5, 1e-3)).friction, 1.0)
    np.testing.assert_allclose(part.grip(state(-1.5, -1e-3)).friction, -1.0)
    assert not interface(0.0).grip(state(0.5, 1e-3)).friction.any()


def test_the_limit_holds_along_the_stretched_curve():
    """The work of the friction is its force along the curve times the stretched slip."""
    free = replace(interface(1.0), along=5 * COUNT + np.arange(2 * len(RADIUS)).reshape(2, -1))
    y = np.zeros(SIZE)
    y[free.along[0]], y[free.own[2]] = 0.25 * RADIUS, 5.0
    grip = free.grip(y)
    np.testing.assert_allclose(grip.stretch, 1.25)
    np.testing.assert_allclose(grip.friction, 1.25)


def test_after_a_slip_it_sticks_where_it_came_to():
    part = interface(1.0)
    later = part.after(state(1.5, 0.1))
    np.testing.assert_allclose(later.anchor, 0.1 - part.give / part.hold)
    np.testing.assert_allclose(later.grip(state(1.0, 0.1)).friction, 1.0)
    assert part.rubs
    assert not interface(0.0).rubs


def test_beyond_the_end_of_the_curve_there_is_none():
    assert interface(1.0).grip(state(0.0, 1.0)) is None
