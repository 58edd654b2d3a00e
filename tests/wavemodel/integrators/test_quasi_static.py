import numpy as np
import pytest

from wavemodel.integrators.load_history import checked_load
from wavemodel.integrators.quasi_static import SharedBody, quasi_static

UNIT, AXIS = np.array([[2.0, 1.0]]), np.array([4.0])


def run(control, time, value, lag=0.0):
    return quasi_static(checked_load(control, time, value), SharedBody(UNIT[None], AXIS[None], 4.0, retardation=lag))


def test_all_modes_follow_the_force():
    history = run("force", [1.0, 2.0], [0.5, -1.0])
    np.testing.assert_allclose(history.depth, [2.0, -4.0])
    np.testing.assert_allclose(history.top_deflection, [[2.0], [-4.0]])
    np.testing.assert_allclose(history.amplitude(1), [[-2.0, -1.0]])


@pytest.mark.parametrize("lag", [0.0, 0.2])
def test_depth_control_reaches_the_depth(lag):
    depth = np.array([1.0, 3.0, 3.0])
    history = run("depth", [0.5, 1.0, 1.5], depth, lag)
    np.testing.assert_allclose(history.depth, depth)


def test_a_kelvin_voigt_solid_resists_the_rate_of_depth():
    """F = (x + eta x') / compliance."""
    history = run("depth", [0.5, 1.0, 1.5], [1.0, 2.0, 2.0], lag=0.25)
    np.testing.assert_allclose(history.force * 4.0, [1.5, 2.5, 2.0])


def test_force_and_depth_control_are_inverse_for_a_broken_line_of_depth():
    time = np.linspace(0.1, 3.0, 30)
    depth = np.minimum(time, 1.0)
    back = run("force", time, run("depth", time, depth).force)
    np.testing.assert_allclose(back.depth, depth)
