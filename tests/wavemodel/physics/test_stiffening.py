import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.body import Physics
from wavemodel.physics.stiffening import StrainStiffening

DEPTH = np.linspace(0.0, 4e-3, 41)


def test_is_its_polynomial(press):
    x = DEPTH / 8e-3
    found = press(Physics(stiffening=StrainStiffening(0.3, 2.0, 8e-3)), DEPTH)
    np.testing.assert_allclose(found, 500.0 * DEPTH * (1 + 0.3 * x + 2.0 * x**2), rtol=1e-13)


def test_off_without_coefficients(press):
    np.testing.assert_array_equal(press(Physics(stiffening=StrainStiffening()), DEPTH), 500.0 * DEPTH)


def test_the_way_back_is_the_way_there(press, path):
    depth = path(0.0, 3e-3, 0.0)
    found = press(Physics(stiffening=StrainStiffening(0.3, 2.0, 8e-3)), depth)
    np.testing.assert_allclose(np.trapezoid(found, depth), 0.0, atol=1e-12)


@pytest.mark.parametrize("wrong", [{"linear": -0.1}, {"quadratic": np.nan}, {"length": 0.0}])
def test_refuses(wrong):
    with pytest.raises(WaveError, match="strain stiffening"):
        StrainStiffening(**wrong)
