import numpy as np
import pytest

from wavemodel import Damping, DiscTool, LayeredWave, Prony, WaveLayer
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


@pytest.mark.parametrize("retardation", [0.0, 0.05])
@pytest.mark.parametrize(
    "series", [Prony((0.5,), (0.3,)), (Prony((0.5,), (0.3,)), None), (Prony((0.5,), (0.3,)), Prony((0.3,), (2.0,)))]
)
def test_a_surface_that_does_not_stick_is_driven_back_by_the_force_it_answers_with(series, retardation):
    """Under that force it stands at the tool or, where there is none, below it; stuck, it pulls."""
    layers = [WaveLayer("upper", 2e-3, 1e3, 60e3, 0.45), WaveLayer("lower", 8e-3, 1e3, 20e3, 0.45)]
    time = np.linspace(0.01, 2.0, 200)
    depth = 1e-3 * np.interp(time, [0.0, 0.1, 1.0, 1.02, 1.3, 1.4, 2.0], [0, 1, 1, -0.2, -0.2, 1, 1])
    forces = {}
    for contact in ("uniform_pressure", "rigid_frictionless", "rigid_bonded"):
        wave = LayeredWave(
            layers,
            DiscTool(3e-3, contact),
            relaxation=series,
            damping=Damping(stiffness_time=retardation),
            large_press="linear",
            integrator="quasi_static",
        )
        pressed = wave.run("depth", time, depth)
        np.testing.assert_array_equal(pressed.depth, depth)
        forces[contact] = pressed.force
        if contact != "rigid_bonded":
            back, free = wave.run("force", time, pressed.force), pressed.force == 0.0
            assert free.sum() > 20
            assert (back.depth[free] > depth[free]).all()
            stands = quasi_static(checked_load("depth", time, depth), wave.body).depth
            assert (stands[free] > depth[free]).all()
            atol = 1e-3 * (5.0 if retardation else 0.02)  # the force jumps where the damped surface is met
            np.testing.assert_allclose(back.depth[~free], depth[~free], atol=atol)
            np.testing.assert_allclose(pressed.top_deflection, back.top_deflection, atol=atol)
    assert all(forces[contact].min() == 0.0 for contact in ("uniform_pressure", "rigid_frictionless"))
    assert forces["rigid_bonded"].min() < -0.05
