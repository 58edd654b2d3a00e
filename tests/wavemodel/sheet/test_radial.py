import numpy as np
import pytest

from wavemodel.sheet.radial import RadialFunctions


@pytest.mark.parametrize("inner", [0.0, 0.4])
def test_strains_are_the_derivatives_of_the_displacement(inner):
    functions = RadialFunctions(inner, 2.0, 6)
    r, step = np.array([0.5, 1.1, 1.9]), 1e-6
    q = np.random.default_rng(0).normal(size=functions.unknowns)
    u, phi, _w = functions.displacement(r) @ q
    up, phip, wp = (functions.displacement(r + step) @ q - functions.displacement(r - step) @ q) / (2 * step)
    np.testing.assert_allclose(functions.strains(r) @ q, [up, u / r, wp, phi, phip], rtol=1e-6, atol=1e-6)


def test_a_whole_disc_is_smooth_on_the_axis():
    functions = RadialFunctions(0.0, 2.0, 6)
    u, phi, _ = functions.displacement(np.zeros(1))
    np.testing.assert_array_equal(u, 0.0)
    np.testing.assert_array_equal(phi, 0.0)
    np.testing.assert_allclose(functions.strains(np.array([1e-12]))[2], 0.0, atol=1e-10)


def test_quadrature_measures_the_area():
    radius, weight = RadialFunctions(0.4, 2.0, 5).quadrature()
    assert weight.sum() == pytest.approx(np.pi * (4.0 - 0.16))
    assert (weight * radius**2).sum() == pytest.approx(np.pi / 2 * (16.0 - 0.0256))
