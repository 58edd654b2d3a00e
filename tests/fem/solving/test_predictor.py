import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fem.solving.predictor import KnownStates
from fem.solving.state import State


def quadratic(v):
    return State(np.array([1.0 + v, v**2]), np.array([[3.0 * v - v**2]]), 2.0 * v + v**2)


def known(values):
    states = KnownStates(0.0, quadratic(0.0))
    for v in values:
        states.add(v, quadratic(v))
    return states


@given(st.floats(-2.0, 5.0))
@settings(deadline=None)
def test_quadratic_paths_are_predicted_exactly(target):
    found, exact = known([1.0, 2.0]).predict(target), quadratic(target)
    np.testing.assert_allclose(found.y, exact.y, atol=1e-10)
    np.testing.assert_allclose(found.pressure, exact.pressure, atol=1e-10)
    assert found.force == pytest.approx(exact.force, abs=1e-10)


def test_one_known_state_predicts_itself():
    found = KnownStates(0.0, quadratic(0.0)).predict(1.0)
    np.testing.assert_array_equal(found.y, quadratic(0.0).y)


def test_nearly_equal_loads_do_not_blow_the_extrapolation_up():
    states = known([1.0])
    noisy = quadratic(1.0)
    states.add(1.0 + 1e-9, State(noisy.y + 1e-6, noisy.pressure, noisy.force))
    assert np.abs(states.predict(1.5).y).max() < 10.0


def test_a_known_load_gives_its_state():
    np.testing.assert_array_equal(known([1.0, 2.0, 3.0]).predict(2.0).y, quadratic(2.0).y)
