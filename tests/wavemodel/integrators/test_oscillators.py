import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from wavemodel import Damping
from wavemodel.integrators.oscillators import oscillator_step


def advanced(frequency, damping, duration, state, before=0.0, change=0.0):
    u, v = np.array([state[0]]), np.array([state[1]])
    oscillator_step(np.array([frequency]), damping, duration).advance(u, v, before, change)
    return u[0], v[0]


@given(st.floats(0.1, 30.0), st.floats(0.0, 60.0), st.floats(0.0, 2.0), st.floats(0.01, 2.0))
def test_a_step_is_the_matrix_exponential(w, mass_rate, stiffness_time, h):
    """u' = w v, v' = w (F - u) - c v with a force linear in time, as one 4 x 4 exponential."""
    c = mass_rate + stiffness_time * w**2
    system = np.array([[0, w, 0, 0], [-w, -c, w, 0], [0, 0, 0, 1 / h], [0, 0, 0, 0]])
    expected = expm(system * h) @ np.array([0.7, -0.2, 1.5, -0.4])
    found = advanced(w, Damping(mass_rate, stiffness_time), h, (0.7, -0.2), 1.5, -0.4)
    np.testing.assert_allclose(found, expected[:2], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("rate", [0.0, 1.0, 20.0, 20.0 * (1 + 1e-12), 1e4])
def test_two_half_steps_make_a_whole_one(rate):
    damping, force = Damping(rate), 0.6
    whole = advanced(10.0, damping, 0.4, (1.0, 0.3), 0.1, force)
    half = advanced(10.0, damping, 0.2, (1.0, 0.3), 0.1, force / 2)
    twice = advanced(10.0, damping, 0.2, half, 0.1 + force / 2, force / 2)
    np.testing.assert_allclose(twice, whole, rtol=1e-12)


@given(st.floats(1.0, 1e10), st.floats(0.0, 1e10), st.floats(1e-7, 1.0), st.floats(1e-9, 1e2))
def test_free_motion_never_grows_for_any_rate(w, mass_rate, stiffness_time, h):
    u, v = advanced(w, Damping(mass_rate, stiffness_time), h, (0.6, 0.8))
    assert u * u + v * v <= 1.0 + 1e-9


def test_a_held_force_is_reached_at_any_rate():
    frequency = np.geomspace(1.0, 1e10, 60)
    u, v = np.zeros(60), np.zeros(60)
    step = oscillator_step(frequency, Damping(5.0, 1e-4), 100.0)
    for _ in range(4):
        step.advance(u, v, 2.0, 0.0)
    np.testing.assert_allclose(u, 2.0, rtol=1e-9)


@pytest.mark.parametrize("duration", [1e-6, 1e-3, 0.1])
def test_free_vibration_keeps_its_energy_over_5000_steps(duration):
    frequency = np.geomspace(50.0, 5e6, 400)
    step = oscillator_step(frequency, Damping(), duration)
    u, v = np.ones(400), np.zeros(400)
    for _ in range(5000):
        step.advance(u, v, 0.0, 0.0)
    energy = u * u + v * v
    assert abs(energy.mean() - 1.0) <= 1e-12
    assert np.abs(energy - 1.0).max() <= 2e-12
