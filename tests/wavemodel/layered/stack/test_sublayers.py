import numpy as np
import pytest

from wavemodel import WaveLayer
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.stack.sublayers import consistent_mass, quadratic_stiffness


@pytest.fixture
def one():
    return laminate([WaveLayer("gel", 2e-3, 1000.0, 3e4, 0.49)], [(1.0,)], "free")


def shape(z, power_u=None, power_w=None):
    """Nodal U, W (top, bottom, middle) of monomials in z / h."""
    nodes = np.array([0.0, 1.0, 0.5])
    vector = np.zeros(6)
    if power_u is not None:
        vector[0::2] = nodes**power_u
    if power_w is not None:
        vector[1::2] = nodes**power_w
    return vector


@pytest.mark.parametrize("k", [20.0, 700.0])
def test_energy_of_polynomial_fields_is_the_integral(one, k):
    h, shear, lame = 2e-3, one.shear_modulus[0], one.lame_modulus[0]
    matrix = quadratic_stiffness(np.array([k]), one)[0, 0]
    lifting, bending, stretching = shape(0, power_w=0), shape(0, power_u=1), shape(0, power_w=1)
    assert lifting @ matrix @ lifting == pytest.approx(shear * k**2 * h)
    assert stretching @ matrix @ stretching == pytest.approx((lame + 2 * shear) / h + shear * k**2 * h / 3)
    assert bending @ matrix @ bending == pytest.approx(k**2 * (lame + 2 * shear) * h / 3 + shear / h)
    assert lifting @ matrix @ bending == pytest.approx(k * shear)
    assert stretching @ matrix @ bending == pytest.approx(k * (0.5 * shear - 0.5 * lame))


def test_the_terms_of_volume_change_take_two_gauss_points(one):
    """A quadratic U: int U^2 is 1/5 exactly and 7/36 by two points, which is what frees nu near one half."""
    matrix = quadratic_stiffness(np.array([1e6]), one)[0, 0]
    curved = shape(0, power_u=2)
    h, shear, lame = 2e-3, one.shear_modulus[0], one.lame_modulus[0]
    expected = 1e12 * h * (lame * 7 / 36 + 2 * shear / 5) + shear * 4 / 3 / h
    assert curved @ matrix @ curved == pytest.approx(expected)


def test_stiffness_is_symmetric_and_positive(one):
    matrix = quadratic_stiffness(np.array([150.0]), one)[0, 0]
    np.testing.assert_allclose(matrix, matrix.T)
    assert np.linalg.eigvalsh(matrix).min() > 0.0


def test_mass_of_a_rigid_motion_is_the_layer_s(one):
    matrix = consistent_mass(one)[0]
    for motion in (shape(0, power_u=0), shape(0, power_w=0)):
        assert motion @ matrix @ motion == pytest.approx(1000.0 * 2e-3)
    linear = shape(0, power_w=1)
    assert linear @ matrix @ linear == pytest.approx(1000.0 * 2e-3 / 3)
