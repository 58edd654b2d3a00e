import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wavemodel.integrators.lag import lag_step, lagged


def test_creep_under_a_ramp_and_hold_is_the_closed_form():
    eta, ramp = 0.3, 0.5
    time = np.linspace(0.05, 2.0, 40)
    force = np.minimum(time / ramp, 1.0)
    exact = np.where(
        time <= ramp + 1e-12,
        (time - eta * (1 - np.exp(-time / eta))) / ramp,
        1 - eta / ramp * (np.exp(ramp / eta) - 1) * np.exp(-time / eta),
    )
    np.testing.assert_allclose(lagged(np.diff(time, prepend=0.0), force, eta), exact, rtol=1e-12)


def test_without_lag_the_force_itself():
    force = np.array([1.0, -2.0])
    np.testing.assert_array_equal(lagged(np.ones(2), force, 0.0), force)


def test_a_first_step_without_duration_is_static():
    assert lagged(np.array([0.0, 1.0]), np.array([2.0, 2.0]), 0.7).tolist() == pytest.approx([2.0, 2.0])


@given(st.floats(1e-9, 1e6), st.floats(1e-9, 1e6))
def test_coefficients_are_a_mean(duration, lag):
    step = lag_step(duration, lag)
    assert step.keep + step.first + step.last == pytest.approx(1.0)
    assert min(step.keep, step.first, step.last) >= -1e-9
