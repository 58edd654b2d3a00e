import numpy as np
import pytest

from fem.assembly.curve import Curve

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
