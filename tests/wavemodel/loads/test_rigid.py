import numpy as np
import pytest
from scipy.special import j0

from wavemodel import NotCoveredError
from wavemodel.loads.half_space import HalfSpace
from wavemodel.loads.rigid import PunchTractions, enough_functions, punch_tractions, solve_contact

HALF = HalfSpace(1.0, 0.3)
STEP = 1e-2
X = (np.arange(300_000) + 0.5) * STEP


def test_first_normal_function_is_the_flat_punch():
    k = np.array([0.2, 1.0, 7.0])
    np.testing.assert_allclose(PunchTractions(2.0, 1).transform(k)[:, 0, 1], np.sin(2 * k) / (2 * k))


def test_flexibility_on_a_half_space_is_its_integral():
    basis = PunchTractions(1.0, 3, 3)
    load = basis.transform(X)
    direct = np.einsum("nic,cd,njd->ij", load, HALF.matrix, load, optimize=True) * STEP / (2 * np.pi)
    tail = 1.0 / X[-1]
    np.testing.assert_allclose(basis.half_space_flexibility(HALF), direct, atol=tail)


@pytest.mark.parametrize("rho", [0.0, 0.3, 0.9, 1.7, 6.0])
def test_deflection_of_a_half_space_is_its_integral(rho):
    basis = PunchTractions(1.0, 3, 3)
    load = basis.transform(X)
    direct = (load @ HALF.matrix[:, 1]).T @ j0(X * rho) * STEP / (2 * np.pi)
    np.testing.assert_allclose(basis.half_space_deflection(HALF, np.array([rho]))[0], direct, atol=2e-4)


def test_on_a_half_space_the_solved_contact_is_the_flat_punch():
    basis = PunchTractions(2e-3, 6)
    traction = solve_contact(basis, basis.half_space_flexibility(HALF))
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
