import numpy as np
import pytest

from wavemodel import WaveLayer
from wavemodel.sheet.layered.stretched_modes import StretchedRadius, stretched_modes
from wavemodel.sheet.layered.through_thickness import sheet_thickness

RADIUS = StretchedRadius(40e-3, 4e-3, ((5e-3, 0.1e-3), (30e-3, 0.2e-3)))


def test_the_radius_is_stretched_between_axis_and_border_and_most_at_the_edges():
    ends = RADIUS.at(np.array([0.0, 40e-3]))
    np.testing.assert_allclose(ends, [0.0, 40e-3], atol=1e-15)
    radius = np.linspace(0.0, 40e-3, 4001)
    slope = RADIUS.slope(radius)
    np.testing.assert_allclose(np.gradient(RADIUS.at(radius), radius)[1:-1], slope[1:-1], rtol=0.02)
    assert radius[slope[:1500].argmax()] == pytest.approx(5e-3, abs=2e-5)


def test_derivatives_of_the_functions_and_the_area():
    modes, radius, step = stretched_modes(RADIUS), np.array([1e-3, 4.9e-3, 17e-3]), 1e-8
    for functions in (modes.outward, modes.level):
        value, slope = functions(radius)
        change = (functions(radius + step)[0] - functions(radius - step)[0]) / (2.0 * step)
        np.testing.assert_allclose(slope, change, atol=1e-5 * np.abs(slope).max())
        assert value.shape[0] == radius.size
    tables = modes.tables()
    assert tables.area.sum() == pytest.approx(np.pi * 40e-3**2, rel=1e-12)
    np.testing.assert_allclose(modes.outward(np.array([40e-3]))[0], 0.0, atol=1e-12)


def test_polynomials_through_the_thickness_give_back_straight_lines():
    layers = [WaveLayer("a", 0.2e-3, 1.0, 1e5, 0.4), WaveLayer("b", 4e-3, 1.0, 1e4, 0.4)]
    cut = sheet_thickness(layers)
    nodes = cut.shape.shape[1]
    np.testing.assert_allclose(cut.shape.sum(axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(cut.slope.sum(axis=1), 0.0, atol=1e-8)
    assert cut.weight.sum() == pytest.approx(4.2e-3)
    assert (cut.faces[0], cut.faces[-1]) == (0, nodes - 1)
    assert cut.shear[0] == pytest.approx(layers[0].shear_modulus)
    assert cut.bulk[-1] == pytest.approx(layers[1].lame_modulus + 2.0 / 3.0 * layers[1].shear_modulus)
