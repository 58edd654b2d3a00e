"""Closed forms of the half-space: a disc of uniform pressure and a flat punch.

On the axis under a disc of radius a with pressure q (Johnson, Contact Mechanics, chapter 3):
u_z = (1 + nu) q / E (2 (1 - nu) (s - z) + z (1 - z / s)), s = sqrt(a^2 + z^2).
Flat frictionless punch: F = 2 E a w / (1 - nu^2) (the same chapter).
"""

import numpy as np
import pytest

import fem

E, A, Q = 200e6, 0.15, 1.1e6
DEPTHS = np.array([0.0, 0.1, 0.15, 0.3, 1.0])
PRINTED = np.array([1.4478, 1.1055, 0.9259, 0.5769, 0.1901]) * 1e-3


def model(contact, nu, steps):
    layers = tuple(
        fem.Layer(f"to {n}", thickness, 1800.0, fem.LinearElastic(E, nu)) for n, thickness in enumerate(steps)
    )
    return fem.prepare(fem.Problem(layers, fem.Tool(A, contact), fem.Support("half_space"), "linear"))


def boussinesq(nu):
    s = np.sqrt(A**2 + DEPTHS**2)
    return (1 + nu) * Q / E * (2 * (1 - nu) * (s - DEPTHS) + DEPTHS * (1 - DEPTHS / s))


def test_the_printed_values_are_the_closed_form():
    np.testing.assert_allclose(boussinesq(0.35), PRINTED, atol=1e-7)


@pytest.mark.parametrize("nu", [0.35, 0.499, 0.4999])
def test_uniform_pressure_on_the_axis_within_a_thousandth(nu):
    found = model("uniform_pressure", nu, [*np.diff(DEPTHS), np.inf])
    solution = found.run(fem.Load("force", [1.0], [Q * np.pi * A**2]))
    assert found.unknowns <= 10_000
    np.testing.assert_allclose(solution.top_deflection[0], boussinesq(nu), rtol=1e-3)


@pytest.mark.parametrize("nu", [0.0, 0.35, 0.499])
def test_flat_punch_within_a_thousandth(nu):
    found = model("rigid_frictionless", nu, [np.inf])
    solution = found.run(fem.Load("depth", [1.0], [1e-3]))
    assert found.unknowns <= 10_000
    assert solution.force[0] == pytest.approx(2 * E * A * 1e-3 / (1 - nu**2), rel=1e-3)


def test_surface_profile_outside_the_punch():
    """w(r) = (2 w / pi) arcsin(a / r) outside (the same chapter)."""
    solution = model("rigid_frictionless", 0.35, [np.inf]).run(fem.Load("depth", [1.0], [1e-3]))
    r = A * np.array([1.2, 1.5, 2.0, 3.0, 5.0])
    np.testing.assert_allclose(solution.profile(0, r)[0], 2e-3 / np.pi * np.arcsin(A / r), rtol=2e-3)
