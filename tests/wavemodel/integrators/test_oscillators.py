import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from wavemodel import Damping, Prony
from wavemodel.integrators.oscillators import OscillatorMotion, oscillator_step, poles


def advanced(frequency, damping, duration, state, before=0.0, change=0.0):
    u, v = np.array([state[0]]), np.array([state[1]])
    oscillator_step(np.array([frequency]), damping.drag(np.array([frequency])), duration).advance(u, v, before, change)
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
    step = oscillator_step(frequency, Damping(5.0, 1e-4).drag(frequency), 100.0)
    for _ in range(4):
        step.advance(u, v, 2.0, 0.0)
    np.testing.assert_allclose(u, 2.0, rtol=1e-9)


@pytest.mark.parametrize("duration", [1e-6, 1e-3, 0.1])
def test_free_vibration_keeps_its_energy_over_5000_steps(duration):
    frequency = np.geomspace(50.0, 5e6, 400)
    step = oscillator_step(frequency, np.zeros(400), duration)
    u, v = np.ones(400), np.zeros(400)
    for _ in range(5000):
        step.advance(u, v, 0.0, 0.0)
    energy = u * u + v * v
    assert abs(energy.mean() - 1.0) <= 1e-12
    assert np.abs(energy - 1.0).max() <= 2e-12


SERIES = Prony((0.25, 0.3), (0.02, 1.5))


def dense(w, damping, series, step, force):
    """u'' / w^2 + c u' / w^2 + u - sum g q = F, tau q' = u - q, by its exponential with v = u' / w."""
    g, tau = np.array(series.strength), np.array(series.time)
    c, n = damping.mass_rate + damping.stiffness_time * w**2, len(g)
    big = np.zeros((n + 4, n + 4))
    big[0, 1] = w
    big[1, : n + 3] = np.concatenate([[-w, -c], w * g, [w]])
    big[2 : n + 2, 0], big[2 : n + 2, 2 : n + 2] = 1 / tau, -np.diag(1 / tau)
    big[n + 2, n + 3] = 1.0
    transfer, state, before, out = expm(big * step), np.zeros(n + 2), 0.0, []
    for value in force:
        state = (transfer @ np.concatenate([state, [before, (value - before) / step]]))[: n + 2]
        before = value
        out.append(state[0])
    return np.array(out)


@pytest.mark.parametrize("w", [0.3, 7.0, 60.0, 3000.0])
@pytest.mark.parametrize("damping", [Damping(), Damping(3.0), Damping(0.0, 0.05)])
@pytest.mark.parametrize("step", [0.001, 0.03, 1.0])
def test_equals_a_dense_solution(w, damping, step):
    force = np.random.default_rng(int(w)).normal(size=40)
    motion = OscillatorMotion(np.array([w]), damping, SERIES)
    motion.prepare(step)
    before, found = 0.0, []
    for value in force:
        motion.advance(before, value - before)
        before = value
        found.append(motion.displacement[0])
    expected = dense(w, damping, SERIES, step, force)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11 * np.abs(force).max())


@settings(deadline=None)
@given(st.floats(-2, 9), st.floats(0, 100), st.floats(0, 1), st.floats(0.01, 0.45), st.floats(-4, 3))
def test_partial_fractions_add_up_at_every_rate(w, mass_rate, stiffness_time, g, tau):
    w, tau = np.array([10.0**w]), 10.0**tau
    damping, series = Damping(mass_rate, stiffness_time), Prony((g, 0.5), (tau, 3.3 * tau))
    p = poles(w, damping, series)
    for s in np.geomspace(1e-6, 1e10, 17):
        full = (s + mass_rate + stiffness_time * w**2) * s / w**2
        full = full + 1 - g / (1 + s * tau) - 0.5 / (1 + s * 3.3 * tau)
        pair = (p.position * p.frequency**2 + p.speed * p.frequency * s) / (s * (s + p.drag) + p.frequency**2)
        assert (pair + (p.weight / (1 + s / p.rate)).sum(axis=0))[0] == pytest.approx(1 / full[0], rel=1e-7, abs=1e-9)


def test_comes_to_rest_where_the_modulus_that_is_left_holds_it():
    motion = OscillatorMotion(np.array([5.0, 5e6]), Damping(1.0), SERIES)
    motion.prepare(1000.0)
    motion.advance(2.0, 0.0)
    np.testing.assert_allclose(motion.displacement, 2.0 / 0.45, rtol=1e-12)
    motion.rest(2.0)
    motion.advance(2.0, 0.0)
    np.testing.assert_allclose(motion.displacement, 2.0 / 0.45, rtol=1e-12)


def test_a_step_is_what_is_free_and_what_the_force_adds():
    motion = OscillatorMotion(np.array([5.0, 80.0]), Damping(1.0), SERIES)
    motion.prepare(0.1)
    motion.advance(0.0, 1.0)
    expected = motion.free() + 0.7 * motion.gain()
    motion.advance(0.7, 0.0)
    np.testing.assert_allclose(motion.displacement, expected, rtol=1e-12)
