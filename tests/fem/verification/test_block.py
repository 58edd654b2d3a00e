"""The disc of uniform pressure on a half-space in three dimensions."""

import numpy as np
import pytest

import fem
from fem.verification.half_space import RADIUS, YOUNGS_MODULUS, settlement

DEPTHS = np.array([0.0, 0.1, 0.15, 0.3, 1.0])


@pytest.mark.parametrize("nu", [pytest.param(0.35, marks=pytest.mark.slow), 0.499])
def test_within_half_a_percent(nu):
    layers = tuple(
        fem.Layer(f"to {n}", thickness, 1800.0, fem.LinearElastic(YOUNGS_MODULUS, nu))
        for n, thickness in enumerate([*np.diff(DEPTHS), np.inf])
    )
    tool, support = fem.Tool(RADIUS, "uniform_pressure"), fem.Support("half_space")
    found = fem.prepare(fem.Problem(layers, tool, support, "linear", geometry="block"))
    solution = found.run(fem.Load("force", [1.0], [1.1e6 * np.pi * RADIUS**2]))
    assert found.unknowns <= 50_000
    np.testing.assert_allclose(solution.top_deflection[0], settlement(DEPTHS, nu), rtol=5e-3)
