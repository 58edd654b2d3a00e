import numpy as np
import pytest

from wavemodel import Damping, DiscTool, LayeredWave, WaveDiscretisation
from wavemodel.integrators.load_history import checked_load
from wavemodel.layered.dynamics import ringing


def test_ringing_of_a_ramp_is_one_over_w_t():
    load = checked_load("force", np.array([1.0]), np.array([5.0]))
    assert ringing(load, 100.0, Damping()) == pytest.approx(1 / (2 * np.pi * 100.0))
    assert ringing(load, 100.0, Damping(2 * np.pi * 100.0)) == pytest.approx(2 / (2 * np.pi * 100.0))


def test_noise_counts_by_its_size_not_its_slope():
    time = np.arange(1, 5001) * 1e-3
    noisy = time / 5.0 + 0.01 * np.random.default_rng(5).uniform(-1, 1, time.size)
    assert ringing(checked_load("force", time, noisy), 100.0, Damping()) < 0.01


def test_an_unloaded_history_does_not_ring():
    assert ringing(checked_load("force", np.array([1.0, 2.0]), np.zeros(2)), 100.0, Damping()) == 0.0


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_oscillators_at_rest_under_unit_force_are_the_statics(skin, contact):
    wave = LayeredWave(
        skin(), DiscTool(5e-3, contact), discretisation=WaveDiscretisation(window=50e-3, modes=12), large_press="linear"
    )
    system, press = wave._modal_system, wave.press
    np.testing.assert_allclose(system.deflection.sum(axis=2), press.unit, rtol=1e-7, atol=1e-9 * press.unit.max())
    assert system.depth.sum() + system.remainder_depth == pytest.approx(press.compliance, rel=1e-9)


def test_the_first_frequency_is_that_of_the_layer_s_shear_and_press(skin):
    """Between a quarter wave of shear in the fat alone (66 Hz) and three times that."""
    wave = LayeredWave(skin(), DiscTool(5e-3), large_press="linear")
    assert 66.0 < wave.first_frequency < 200.0
    assert wave.first_frequency == pytest.approx(wave._modal_system.frequency.min() / (2 * np.pi), rel=0.01)
