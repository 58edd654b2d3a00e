"""The round window against exact layered elasticity, the square window, and closed forms."""

import numpy as np
import pytest
from scipy.special import j0

from wavemodel import DiscTool, LayeredWave, WaveError
from wavemodel.domains.disc import Disc
from wavemodel.domains.endless import endless
from wavemodel.layers.compliance import compliance, exact_faces
from wavemodel.layers.laminate import laminate
from wavemodel.loads.uniform import uniform_pressure

TOOL, BORDER, MODES = 5e-3, 45e-3, 400
RADII = np.linspace(0.0, 20e-3, 41)


def amplitudes(stack, wavenumber):
    load = uniform_pressure(TOOL).transform(wavenumber)
    return compliance(wavenumber, stack, exact_faces).respond(load)[..., 1].T


@pytest.fixture
def stack(skin):
    layers = skin()
    return laminate(layers, [np.ones(1)] * len(layers), "bonded")


def test_every_mode_ends_at_the_border_and_gives_itself_back():
    disc, share = Disc(BORDER, 6), np.arange(1.0, 7.0)
    assert np.abs(disc.at_radius(share, np.array([BORDER]))).max() < 1e-9 * np.abs(share * disc.weight).max()
    point, weight = np.polynomial.legendre.leggauss(60)
    radius = 0.5 * BORDER * (point + 1.0)
    area = np.pi * BORDER * weight * radius
    found = (j0(np.outer(disc.wavenumber, radius)) * area) @ disc.at_radius(share, radius)
    np.testing.assert_allclose(found, share, rtol=1e-10)


def test_a_press_is_that_of_the_endless_specimen(stack):
    """Within 0.1 % of each layer's peak: border and modes together."""
    disc = Disc(BORDER, MODES)
    spectrum = endless(disc.wavenumber[-1], 0.1)
    found = disc.at_radius(amplitudes(stack, disc.wavenumber), RADII)
    exact = spectrum.at_radius(amplitudes(stack, spectrum.wavenumber), RADII)
    assert np.abs(found - exact).max() < 1e-3 * exact[:, 0].min()


def test_round_and_square_window_agree(skin, stack):
    """Within 0.3 % of each layer's peak."""
    disc = Disc(BORDER, MODES)
    found = disc.at_radius(amplitudes(stack, disc.wavenumber), RADII)
    wave = LayeredWave(skin(), DiscTool(TOOL), window=2.0 * BORDER)
    square = wave.run("force", np.array([10.0]), np.array([1.0])).profile(0, RADII)
    np.testing.assert_allclose(found / square[:, :1], square / square[:, :1], atol=3e-3)


def test_refuses_what_is_no_disc():
    for wrong in ((0.0, 3), (1e-2, 0)):
        with pytest.raises(WaveError):
            Disc(*wrong)
    with pytest.raises(WaveError, match="outside 0 to 45 mm"):
        Disc(BORDER, 3).at_radius(np.ones(3), np.array([46e-3]))
