import numpy as np
import pytest
from scipy.special import j0

from wavemodel import NotCoveredError
from wavemodel.layered.tractions import (
    HalfSpace,
    PunchTractions,
    UniformPressure,
    enough_functions,
    punch_tractions,
    solve_contact,
    uniform_pressure,
)


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


PUNCHED = HalfSpace(1.0, 0.3)
STEP = 1e-2
SPAN = (np.arange(300_000) + 0.5) * STEP


def test_first_normal_function_is_the_flat_punch():
    k = np.array([0.2, 1.0, 7.0])
    np.testing.assert_allclose(PunchTractions(2.0, 1).transform(k)[:, 0, 1], np.sin(2 * k) / (2 * k))


def test_flexibility_on_a_half_space_is_its_integral():
    basis = PunchTractions(1.0, 3, 3)
    load = basis.transform(SPAN)
    direct = np.einsum("nic,cd,njd->ij", load, PUNCHED.matrix, load, optimize=True) * STEP / (2 * np.pi)
    tail = 1.0 / SPAN[-1]
    np.testing.assert_allclose(basis.half_space_flexibility(PUNCHED), direct, atol=tail)


@pytest.mark.parametrize("rho", [0.0, 0.3, 0.9, 1.7, 6.0])
def test_deflection_of_a_half_space_is_its_integral(rho):
    basis = PunchTractions(1.0, 3, 3)
    load = basis.transform(SPAN)
    direct = (load @ PUNCHED.matrix[:, 1]).T @ j0(SPAN * rho) * STEP / (2 * np.pi)
    np.testing.assert_allclose(basis.half_space_deflection(PUNCHED, np.array([rho]))[0], direct, atol=2e-4)


def test_on_a_half_space_the_solved_contact_is_the_flat_punch():
    basis = PunchTractions(2e-3, 6)
    traction = solve_contact(basis, basis.half_space_flexibility(PUNCHED))
    np.testing.assert_allclose(traction.coefficients, [1, 0, 0, 0, 0, 0], atol=1e-12)


def test_no_slip_on_a_compressible_half_space_stiffens_the_punch_as_in_closed_form():
    """Mossakovskii and Spence: F = 4 G a w ln(3 - 4 nu) / (1 - 2 nu)."""
    nu = 0.3
    basis = PunchTractions(1.0, 24, 24)
    half = HalfSpace(1.0 - nu, 0.5 - nu)
    flexibility = basis.half_space_flexibility(half)
    traction = solve_contact(basis, flexibility)
    depth = traction.coefficients @ flexibility @ traction.coefficients
    assert 1.0 / depth == pytest.approx(4 * np.log(3 - 4 * nu) / (1 - 2 * nu), rel=2e-4)


def test_thin_first_layers_take_more_functions():
    assert enough_functions(1.0) == 8
    assert enough_functions(0.02) == 17
    assert enough_functions(1e-6) == 32


def test_friction_is_not_covered():
    with pytest.raises(NotCoveredError, match="rigid_frictional"):
        punch_tractions(1e-3, "rigid_frictional", 4)
