import numpy as np
import pytest

from wavemodel import WaveLayer
from wavemodel.layered.stack.compliance import compliance
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.stack.sublayers import consistent_mass, quadratic_stiffness
from wavemodel.layered.stack.vibration import assemble, vibration


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
