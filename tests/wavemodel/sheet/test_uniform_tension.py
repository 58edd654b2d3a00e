import numpy as np
import pytest

from wavemodel import Damping
from wavemodel.integrators.load_history import checked_load
from wavemodel.sheet.carrier import carrier
from wavemodel.sheet.uniform_tension import integrate


@pytest.fixture(scope="module")
def wave(pressed_sheet):
    return carrier(pressed_sheet("rigid_bonded"))


@pytest.mark.parametrize("step", [1e-5, 1e-3])
def test_energy_stays_over_5000_steps(wave, step):
    time = step * np.arange(5001)
    released = integrate(checked_load("force", time, np.r_[1.0, np.zeros(5000)]), wave, Damping(), wave.at_rest(1.0)[0])
    energy = released.energy[1:]
    assert np.abs(energy / energy[0] - 1.0).max() <= 1e-12
    assert released.depth.min() < -0.5 * released.depth.max()


def test_second_order_in_the_step(wave):
    ends = []
    for count in (400, 800, 1600):
        time = np.linspace(0.0, 0.02, count + 1)[1:]
        ends.append(integrate(checked_load("force", time, 40.0 * time), wave, Damping(), 0.0 * wave.push).depth[-1])
    assert abs(ends[0] - ends[1]) / abs(ends[1] - ends[2]) == pytest.approx(4.0, rel=0.25)


def test_a_slow_press_with_drag_is_at_rest_at_every_instant(wave):
    time = np.linspace(0.0, 20.0, 401)[1:]
    moving = integrate(checked_load("force", time, 0.1 * time), wave, Damping(mass_rate=400.0), 0.0 * wave.push)
    resting = [wave.pressed @ wave.at_rest(force)[0] for force in 0.1 * time]
    np.testing.assert_allclose(moving.depth[40:], resting[40:], rtol=5e-3)


def test_depth_control_keeps_the_depth(wave):
    time = np.linspace(0.0, 1.0, 101)[1:]
    run = integrate(checked_load("depth", time, 5e-3 * time), wave, Damping(mass_rate=200.0), 0.0 * wave.push)
    np.testing.assert_allclose(run.depth, 5e-3 * time, rtol=1e-9)
    assert run.force[-1] == pytest.approx(wave.at_rest(5e-3, True)[1], rel=0.02)


def test_damping_takes_energy(wave):
    time = 1e-4 * np.arange(301)
    load = checked_load("force", time, np.r_[1.0, np.zeros(300)])
    for damping in (Damping(mass_rate=50.0), Damping(stiffness_time=1e-4)):
        energy = integrate(load, wave, damping, wave.at_rest(1.0)[0]).energy[1:]
        assert (np.diff(energy) <= 1e-15).all()
        assert energy[-1] < 0.8 * energy[0]
