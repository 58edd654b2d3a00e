import numpy as np
import pytest

from wavemodel import Prony, WaveError
from wavemodel.physics.quasi_static_press import Physics, QuasiStaticPress
from wavemodel.physics.time_dependent import PoroelasticDrainage, ViscousDamping

SERIES = Prony((0.3, 0.2), (0.4, 6.0))


def test_a_ramp_and_hold_is_the_closed_form():
    """F = K v int G over the ramp: (1 - sum g) t + sum g tau (1 - e^(-t / tau)), shifted in the hold."""
    time, ramp, g, tau = np.linspace(0.1, 12.0, 120), 2.0, np.array([0.3, 0.2]), np.array([0.4, 6.0])
    found = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES)).force(time, np.minimum(time, ramp) * 1e-3)
    start, end = np.maximum(time - ramp, 0.0)[:, None], np.minimum(time, ramp)
    fading = (g * tau * (np.exp(-start / tau) - np.exp(-time[:, None] / tau))).sum(axis=1)
    np.testing.assert_allclose(found, 0.5 * (0.5 * end + fading), rtol=1e-12)


def test_forgets():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES))
    time = np.array([1.0, 2.0, 3.0, 300.0, 301.0])
    again = press.force(time, np.array([1e-3, 3e-3, 0.0, 0.0, 1e-3]))
    assert again[-1] == pytest.approx(again[0], rel=1e-12)


def test_a_history_that_begins_at_zero_begins_relaxed():
    held = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES)).force(
        np.array([0.0, 5.0]), np.full(2, 1e-3)
    )
    np.testing.assert_allclose(held, 0.25)


def test_a_tool_lifted_faster_than_the_tissue_follows_is_not_pulled():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES))
    force = press.force(np.array([1.0, 60.0, 60.1, 60.2]), np.array([3e-3, 3e-3, 0.1e-3, 0.1e-3]))
    assert force[1] == pytest.approx(0.75, rel=1e-3)
    np.testing.assert_array_equal(force[2:], 0.0)


def hold(time, radius, strength=0.4, depth=1e-3):
    """After a step of depth within a nanosecond."""
    option = PoroelasticDrainage(strength, 1e-8, radius)
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(drainage=option))
    return press.force(np.concatenate([[1e-9], time]), np.full(time.size + 1, depth))[1:]


def test_drains_by_the_square_root_of_time_at_first():
    time = np.array([2.0, 4.0, 8.0])
    xi = 1e-8 * time / 4e-6
    np.testing.assert_allclose(hold(time, 2e-3), 0.5 * (1 - 0.4 * 2 * np.sqrt(xi / np.pi)), rtol=2e-3)


def test_goes_down_to_what_the_solid_carries_alone():
    assert hold(np.array([1e5]), 2e-3)[0] == pytest.approx(0.5 * 0.6, rel=1e-9)


def test_takes_longer_by_the_square_of_the_contact_size():
    time = np.geomspace(1.0, 1e4, 9)
    np.testing.assert_allclose(hold(4.0 * time, 4e-3), hold(time, 2e-3), rtol=1e-7)


def test_a_ball_touches_as_hertz_says():
    ball = PoroelasticDrainage(0.4, 1e-8, 5e-3, 5e-3)
    depth = np.array([-1.0, 0.2e-3, 1e-3, 1.0])
    np.testing.assert_allclose(ball.contact_radius(depth), [0.25e-3, 1e-3, np.sqrt(5.0) * 1e-3, 5e-3], rtol=1e-9)


@pytest.mark.parametrize("touched", [3.2e-3, 4.0e-3, 4.9e-3])
def test_a_rounded_edge_touches_as_sneddon_says(touched):
    flat, edge = 3e-3, 2e-3
    angle = np.linspace(np.arcsin(flat / touched), 0.5 * np.pi, 20001)
    sunk = touched * np.trapezoid((touched * np.sin(angle) - flat) / edge, angle)
    contact = PoroelasticDrainage(0.4, 1e-8, flat + edge, edge).contact_radius(np.array([0.0, sunk]))
    np.testing.assert_allclose(contact, [flat, touched], rtol=1e-5)


def test_a_ball_drains_slower_as_it_sinks_in():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(drainage=PoroelasticDrainage(0.4, 1e-8, 5e-3, 5e-3)))
    time = np.array([1e-6, 10.0, 20.0])
    kept = [press.force(time, np.full(3, depth))[1] / depth for depth in (0.2e-3, 1e-3)]
    assert kept[0] < 0.99 * kept[1]


def test_drainage_is_off_at_zero():
    np.testing.assert_allclose(hold(np.array([1.0, 100.0]), 2e-3, strength=0.0), 0.5, rtol=1e-14)


@pytest.mark.parametrize("wrong", [(1.0, 1e-8, 1e-3), (0.3, 0.0, 1e-3), (0.3, 1e-8, 0.0), (0.3, 1e-8, 1e-3, 1.1e-3)])
def test_drainage_refuses(wrong):
    with pytest.raises(WaveError, match="drainage"):
        PoroelasticDrainage(*wrong)


DAMPED = Physics(damping=ViscousDamping(0.2))


def test_adds_the_speed_times_eta_and_stiffness(press):
    depth = np.linspace(0.0, 2e-3, 21)[1:]
    np.testing.assert_allclose(press(DAMPED, depth, speed=1e-2), 500.0 * (depth + 0.2 * 1e-2), rtol=1e-12)


def test_is_gone_in_a_hold(press):
    depth = np.array([1e-3, 2e-3, 2e-3])
    assert press(DAMPED, depth)[-1] == pytest.approx(1.0)


def test_loses_energy_with_the_speed(press, path):
    depth = path(1e-3, 3e-3, 2e-3, 3e-3, points=2001)
    cycle = slice(np.argmax(depth), None)
    lost = [np.trapezoid(press(DAMPED, depth, speed)[cycle], depth[cycle]) for speed in (1e-3, 2e-3)]
    assert lost[1] / lost[0] == pytest.approx(2.0, rel=1e-2)
    assert lost[0] == pytest.approx(500.0 * 0.2 * 1e-3 * 2e-3, rel=1e-2)


def test_damping_is_off_at_zero(press, path):
    depth = path(0.0, 3e-3, 0.0)
    np.testing.assert_array_equal(press(Physics(damping=ViscousDamping(0.0)), depth), 500.0 * depth)


def test_damping_refuses():
    with pytest.raises(WaveError, match="retardation = -1 s"):
        ViscousDamping(-1.0)
