"""The round window against exact layered elasticity, the square window, and closed forms."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.special import j0

from wavemodel import DiscTool, LayeredWave, NotCoveredError, WaveDiscretisation, WaveError
from wavemodel.domains.disc import Disc
from wavemodel.domains.domain import endless
from wavemodel.layered.stack.compliance import compliance, exact_faces
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.tractions import uniform_pressure

TOOL, BORDER, MODES = 5e-3, 45e-3, 400
RADII = np.linspace(0.0, 20e-3, 41)


def along(disc, amplitude, radius):
    return disc.at(np.atleast_2d(amplitude), np.stack([radius, np.zeros_like(radius)], axis=1))


def amplitudes(stack, wavenumber):
    load = uniform_pressure(TOOL).transform(wavenumber)
    return compliance(wavenumber, stack, exact_faces).respond(load)[..., 1].T


@pytest.fixture
def stack(skin):
    layers = skin()
    return laminate(layers, [np.ones(1)] * len(layers), "bonded")


def test_every_mode_ends_at_the_border_and_gives_itself_back():
    disc, share = Disc(BORDER, 6), np.arange(1.0, 7.0)
    assert np.abs(along(disc, share, np.array([BORDER]))).max() < 1e-9 * np.abs(share * disc.weight).max()
    point, weight = np.polynomial.legendre.leggauss(60)
    radius = 0.5 * BORDER * (point + 1.0)
    area = np.pi * BORDER * weight * radius
    found = (j0(np.outer(disc.wavenumber, radius)) * area) @ along(disc, share, radius)[0]
    np.testing.assert_allclose(found, share, rtol=1e-10)


def test_a_press_is_that_of_the_endless_specimen(stack):
    """Within 0.1 % of each layer's peak: border and modes together."""
    disc = Disc(BORDER, MODES)
    spectrum = endless(disc.wavenumber[-1], 0.1)
    found = along(disc, amplitudes(stack, disc.wavenumber), RADII)
    exact = spectrum.at_radius(amplitudes(stack, spectrum.wavenumber), RADII)
    assert np.abs(found - exact).max() < 1e-3 * exact[:, 0].min()


def test_round_and_square_window_agree(skin, stack):
    """Within 0.3 % of each layer's peak."""
    disc = Disc(BORDER, MODES)
    found = along(disc, amplitudes(stack, disc.wavenumber), RADII)
    wave = LayeredWave(
        skin(), DiscTool(TOOL), discretisation=WaveDiscretisation(window=2.0 * BORDER), large_press="linear"
    )
    square = wave.run("force", np.array([10.0]), np.array([1.0])).profile(0, RADII)
    np.testing.assert_allclose(found / square[:, :1], square / square[:, :1], atol=3e-3)


def test_refuses_what_is_no_disc():
    for wrong in ((0.0, 3), (1e-2, 0)):
        with pytest.raises(WaveError):
            Disc(*wrong)
    with pytest.raises(WaveError, match="border is at 45 mm"):
        along(Disc(BORDER, 3), np.ones(3), np.array([46e-3]))
    with pytest.raises(NotCoveredError, match="differs along x and y"):
        _ = Disc(BORDER, 3).direction
    with pytest.raises(WaveError, match="different vertices"):
        Disc(BORDER, 40, (1e-3, 0.0)).tables(np.linspace(-1e-2, 1e-2, 512), np.linspace(-1e-2, 1e-2, 512), 3)


def test_off_the_middle_every_order_takes_part_and_roots_interlace():
    disc = Disc(1.0, 12, (0.3, 0.1))
    roots = [disc.wavenumber[disc.order == n] for n in range(disc.order.max() + 1)]
    assert [len(r) for r in roots[:3]] == [12, 11, 11]
    for one, after in pairwise(roots):
        assert np.all(one[: after.size] < after)
        assert np.all(after[: one.size - 1] < one[1 : after.size + 1])


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.2, -0.35)])
def test_orthogonal_modes_give_a_smooth_field_back(place):
    """Its integral over the disc, and its slope by differences."""
    disc = Disc(1.0, 8, place)
    amplitude = np.exp(-((disc.wavenumber / 8.0) ** 2))
    point, weight = np.polynomial.legendre.leggauss(40)
    radius, turn = 0.5 * (point + 1.0), np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    polar = np.stack([np.outer(radius, np.cos(turn)), np.outer(radius, np.sin(turn))], axis=-1)
    field = disc.at(amplitude[None], polar.reshape(-1, 2) - np.array(place)).reshape(40, 64)
    area = 0.5 * weight * radius * 2.0 * np.pi / 64.0
    energy = float(amplitude**2 @ disc.axis_weight)
    assert np.einsum("i,ij->", area, field**2) == pytest.approx(energy, rel=1e-9)
    at, step = np.array([[0.1, -0.2], [0.0, 0.3], [0.0, 0.0]]), 1e-5
    slope = disc.gradient(amplitude, at)
    for axis in (0, 1):
        shift = np.eye(2)[axis] * step
        numeric = (disc.at(amplitude[None], at + shift) - disc.at(amplitude[None], at - shift))[0] / (2.0 * step)
        np.testing.assert_allclose(slope[:, axis], numeric, atol=1e-7 * np.abs(slope).max() + 1e-8)


@pytest.mark.parametrize("place", [(0.0, 0.0), (4e-3, -3e-3)])
def test_tables_hold_the_field_at_the_vertices(place):
    disc = Disc(BORDER, 10, place)
    amplitude = np.random.default_rng(5).normal(size=(2, disc.pairs))
    x, y = np.linspace(-9e-3, 9e-3, 7), np.linspace(-6e-3, 6e-3, 5)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    expected = disc.at(amplitude, points).reshape(2, 7, 5)
    tables, out = disc.tables(x, y, 2), np.ones((14, 5))
    tables.write(amplitude, out, add=True)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(out.reshape(7, 2, 5).transpose(1, 0, 2) - 1.0, expected, atol=1e-12 * scale)
    tables.write(amplitude, out, add=False)
    np.testing.assert_allclose(out.reshape(7, 2, 5).transpose(1, 0, 2), expected, atol=1e-12 * scale)
