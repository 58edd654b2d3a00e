import numpy as np
import pytest
from scipy.special import j1

from wavemodel import WaveLayer
from wavemodel.large_press.disc_modes import disc_modes, thickness_of
from wavemodel.layers.laminate import laminate

MODES = disc_modes(20e-3, 2000.0)


def test_modes_are_orthogonal_and_stay_within_a_wall():
    gram = MODES.level.T @ (MODES.area[:, None] * MODES.level)
    scale = np.sqrt(np.outer(MODES.square, MODES.square))
    np.testing.assert_allclose(gram / scale, np.eye(MODES.square.size), atol=5e-4)
    np.testing.assert_allclose((gram / scale)[:10, :10], np.eye(10), atol=1e-5)
    np.testing.assert_allclose(j1(MODES.wavenumber * 20e-3), 0.0, atol=1e-6)
    np.testing.assert_allclose(MODES.area.sum(), np.pi * 20e-3**2)
    assert MODES.wavenumber[-1] == pytest.approx(2000.0, abs=1.5 * np.pi / 20e-3)


def test_slopes_are_those_of_the_modes():
    """u = -U J_1, w = W J_0: divergence -k J_0 from radial and hoop parts together, and dw/dr = -k J_1."""
    np.testing.assert_allclose(MODES.radial + MODES.hoop, -MODES.wavenumber * MODES.level, atol=1e-9)
    np.testing.assert_allclose(MODES.slope, MODES.wavenumber * MODES.outward, rtol=1e-12)


def test_functions_through_the_thickness_are_quadratic_from_node_to_node():
    layers = [WaveLayer("a", 1e-3, 1000.0, 1e5, 0.3), WaveLayer("b", 3e-3, 1000.0, 2e4, 0.45)]
    made = thickness_of(laminate(layers, [(1.0,), (0.5, 0.5)], "bonded"))
    node = np.array([0.0, 0.5, 1.0, 1.75, 2.5, 3.25]) * 1e-3
    point = made.shape @ (node - 4e-3) + 4e-3
    square = made.shape @ ((node - 4e-3) ** 2)
    np.testing.assert_allclose(square, (point - 4e-3) ** 2, rtol=1e-12)
    np.testing.assert_allclose(made.slope @ (node - 4e-3), 1.0, rtol=1e-12)
    assert made.weight.sum() == np.float64(4e-3)
    np.testing.assert_allclose(node[made.top], [0.0, 1e-3])
    np.testing.assert_allclose(made.bulk[0], 1e5 / 3 / (1 - 0.6))
