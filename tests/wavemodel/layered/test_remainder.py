import numpy as np
import pytest

from wavemodel.domains.domain import endless
from wavemodel.domains.rectangle import Rectangle
from wavemodel.layered.remainder import remainder
from wavemodel.layered.stack.compliance import compliance, exact_faces
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.tractions import UniformPressure, punch_tractions, uniform_pressure
from wavemodel.layered.window import Taper

RADIUS = 5e-3


@pytest.fixture
def stack(skin):
    return laminate(skin(), [(1.0,)] * 3, "bonded")


def smooth_part(stack, taper, load, radii):
    line = endless(taper.limit * 1.3, 40e-3)
    answer = compliance(line.wavenumber, stack, exact_faces).respond(load.transform(line.wavenumber))[..., 1].T
    return line.at_radius(answer * taper.modes(line.wavenumber), radii)


@pytest.mark.parametrize("limit", [1.2e3, 2.4e3, 6e3])
def test_smooth_part_and_remainder_make_the_exact_response(stack, skin, oracle, uniform_load, limit):
    """Whatever is left to the modes, the sum is layered elasticity."""
    taper, window = Taper(limit), Rectangle(70e-3, 70e-3, 50)
    radii = np.array([0.0, 2e-3, 4.9e-3, 5e-3, 6e-3, 10e-3, 20e-3])
    rest = remainder(stack, UniformPressure(RADIUS), taper, window)
    found = smooth_part(stack, taper, uniform_pressure(RADIUS), radii) + rest.deflection(np.ones(1), radii)
    exact = oracle(skin()).deflection(radii, uniform_load(RADIUS), 60e3, 25e-3)
    np.testing.assert_allclose(found / exact[:, :1], exact / exact[:, :1], atol=5e-4)


def test_the_remainder_is_local(stack):
    rest = remainder(stack, UniformPressure(RADIUS), Taper(2.4e3), Rectangle(70e-3, 70e-3, 50))
    near, edge = np.abs(rest.deflection(np.ones(1), np.array([4e-3, 0.999 * rest.reach]))).max(axis=0)
    assert edge < 0.05 * near
    np.testing.assert_array_equal(rest.deflection(np.ones(1), np.array([1.01 * rest.reach])), 0.0)


def test_flexibility_is_the_work_on_the_deflection(stack):
    """For the flat punch: mean of its own deflection weighted by 1 / sqrt(1 - r^2 / a^2)."""
    basis = punch_tractions(RADIUS, "rigid_frictionless", 1)
    rest = remainder(stack, basis, Taper(2.4e3), Rectangle(70e-3, 70e-3, 50))
    point, weight = np.polynomial.legendre.leggauss(60)
    height = 0.5 * (point + 1.0)
    deflection = rest.deflection(np.ones(1), RADIUS * np.sqrt(1.0 - height**2))[0]
    assert rest.flexibility[0, 0] == pytest.approx(0.5 * weight @ deflection, rel=1e-4)
