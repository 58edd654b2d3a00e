"""What the half-space cases do not gate: the printed digits, other Poisson's ratios and the free surface."""

import numpy as np
import pytest

import fem
from fem.verification.indentation import INDENTATION, RADIUS, YOUNGS_MODULUS, disc, half_space, punch, settlement

PRINTED = np.array([1.4478, 1.1055, 0.9259, 0.5769, 0.1901]) * 1e-3


def test_the_printed_values_are_the_closed_form():
    np.testing.assert_allclose(settlement(np.array([0.0, 0.1, 0.15, 0.3, 1.0]), 0.35), PRINTED, atol=1e-7)


@pytest.mark.parametrize("case", [disc, punch])
@pytest.mark.parametrize("nu", [0.0, 0.4999])
def test_holds_at_the_ends_of_the_range(case, nu):
    assert all(quantity.passed for quantity in case(nu))


def test_surface_profile_outside_the_punch():
    """w(r) = (2 w / pi) arcsin(a / r) outside (Johnson, chapter 3)."""
    solution = half_space("rigid_frictionless", 0.35, (np.inf,)).run(fem.Load("depth", [1.0], [INDENTATION]))
    r = RADIUS * np.array([1.2, 1.5, 2.0, 3.0, 5.0])
    exact = 2 * INDENTATION / np.pi * np.arcsin(RADIUS / r)
    np.testing.assert_allclose(solution.profile(0, r)[0], exact, rtol=2e-3)


def test_a_wrong_modulus_would_be_seen(monkeypatch):
    """The case compares with the closed form of the stated modulus, not with itself."""
    monkeypatch.setattr("fem.verification.indentation.LinearElastic", lambda e, nu: fem.LinearElastic(1.01 * e, nu))
    (found,) = punch(0.35)
    assert not found.passed
    assert found.error_percent == pytest.approx(1.0, abs=0.1)
    assert YOUNGS_MODULUS == 200e6
