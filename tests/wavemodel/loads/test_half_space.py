import numpy as np
import pytest

from wavemodel.loads.half_space import HalfSpace
from wavemodel.loads.rigid import PunchTractions
from wavemodel.loads.uniform import UniformPressure


def body(youngs_modulus, nu):
    shear = youngs_modulus / (2 * (1 + nu))
    return HalfSpace.of(shear, 2 * shear * nu / (1 - 2 * nu))


def test_flat_punch_on_a_half_space():
    """F = 2 E a w / (1 - nu^2)."""
    half = body(2e4, 0.45)
    depth = PunchTractions(3e-3, 1).half_space_flexibility(half)[0, 0]
    assert 1.0 / depth == pytest.approx(2 * 2e4 * 3e-3 / (1 - 0.45**2))


def test_uniform_pressure_on_a_half_space():
    """Published: E = 200 MPa, nu = 0.35, a = 150 mm, q = 1.1 MPa: 1.4478 mm on the axis; at the edge 2/pi of it."""
    force = 1.1e6 * np.pi * 0.15**2
    found = UniformPressure(0.15).half_space_deflection(body(200e6, 0.35), np.array([0.0, 0.15]))[:, 0] * force
    assert found[0] == pytest.approx(1.4478e-3, abs=1e-7)
    assert found[1] == pytest.approx(found[0] * 2 / np.pi, rel=1e-9)
