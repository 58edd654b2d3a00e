import numpy as np
import pytest
from scipy.special import j0

from wavemodel.loads.half_space import HalfSpace
from wavemodel.loads.uniform import UniformPressure, uniform_pressure

HALF = HalfSpace(1.0, 0.1)
X = (np.arange(200_000) + 0.5) * 5e-3


def test_transform_is_that_of_the_pressure():
    k = np.array([0.1, 2.0, 9.0])
    r = (np.arange(4000) + 0.5) / 4000 * 1.5
    direct = 2 / 1.5**2 * (j0(np.outer(k, r)) * r).sum(axis=1) * 1.5 / 4000
    np.testing.assert_allclose(uniform_pressure(1.5).transform(k)[:, 1], direct, atol=1e-7)
    np.testing.assert_array_equal(uniform_pressure(1.5).transform(k)[:, 0], 0.0)


@pytest.mark.parametrize("rho", [0.0, 0.4, 0.97, 1.6, 8.0])
def test_half_space_deflection_is_its_integral(rho):
    pressure = UniformPressure(1.0)
    direct = (pressure.transform(X)[:, 0, 1] * j0(X * rho)).sum() * 5e-3 / (2 * np.pi)
    assert pressure.half_space_deflection(HALF, np.array([rho]))[0, 0] == pytest.approx(direct, abs=2e-5)


def test_half_space_flexibility_is_its_integral():
    pressure = UniformPressure(1.0)
    direct = (pressure.transform(X)[:, 0, 1] ** 2).sum() * 5e-3 / (2 * np.pi)
    assert pressure.half_space_flexibility(HALF)[0, 0] == pytest.approx(direct, rel=1e-5)
