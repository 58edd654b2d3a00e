import numpy as np
import pytest

from wavemodel import Damping, DiscTool, LayeredWave, WaveDiscretisation, WaveLayer
from wavemodel.integrators.load_history import checked_load
from wavemodel.layered.dynamics import assemble, ringing, vibration
from wavemodel.layered.stack.compliance import compliance
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.stack.sublayers import consistent_mass, quadratic_stiffness


@pytest.mark.parametrize("base", ["bonded", "free"])
def test_static_answers_of_the_modes_add_up_to_the_compliance(skin, base):
    stack = laminate(skin(), [(1.0,), (0.5, 0.5), (1.0,)], base)
    k = np.array([100.0, 900.0])
    modes = vibration(k, stack)
    summed = np.einsum("nld,ndc->nlc", modes.deflection, modes.surface)
    np.testing.assert_allclose(summed, compliance(k, stack).faces[:, :, 1], rtol=1e-9)


def test_rayleigh_quotients_of_the_shapes_are_the_frequencies(skin):
    stack = laminate(skin(), [(1.0,)] * 3, "bonded")
    k = np.array([150.0])
    stiffness = assemble(quadratic_stiffness(k, stack), "bonded")[0]
    mass = assemble(consistent_mass(stack), "bonded")
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real
    np.testing.assert_allclose(np.sort(vibration(k, stack).frequency[0]), np.sqrt(np.sort(squares)), rtol=1e-6)


def test_a_long_wave_on_a_bonded_layer_shears_at_a_quarter_wavelength():
    layer = WaveLayer("gel", 10e-3, 1000.0, 2e4, 0.45)
    stack = laminate([layer], [(0.125,) * 8], "bonded")
    lowest = vibration(np.array([0.05]), stack).frequency.min()
    assert lowest == pytest.approx(0.5 * np.pi / 10e-3 * np.sqrt(layer.shear_modulus / 1000.0), rel=1e-4)


def test_one_layer_moving_as_one_is_the_membrane_of_eq_1():
    """W constant through the thickness and no U: K = G h k^2 and M = rho h, so c^2 = T / (rho h) with T = G h."""
    layer = WaveLayer("dermis", 1.5e-3, 1116.0, 1e5, 0.48)
    stack = laminate([layer], [(1.0,)], "free")
    k = np.array([133.0, 188.0])
    rigid = np.array([0.0, 1.0, 0.0, 1.0, 0.0, 1.0])
    stiffness = np.einsum("i,nij,j->n", rigid, quadratic_stiffness(k, stack)[:, 0], rigid)
    mass = rigid @ consistent_mass(stack)[0] @ rigid
    np.testing.assert_allclose(stiffness / mass, layer.shear_modulus / layer.density * k**2)


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
