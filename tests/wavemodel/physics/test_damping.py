import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.body import Physics
from wavemodel.physics.damping import ViscousDamping

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


def test_off_at_zero(press, path):
    depth = path(0.0, 3e-3, 0.0)
    np.testing.assert_array_equal(press(Physics(damping=ViscousDamping(0.0)), depth), 500.0 * depth)


def test_refuses():
    with pytest.raises(WaveError, match="retardation = -1 s"):
        ViscousDamping(-1.0)
