"""The reference itself: where layers are alike, or so thick or thin that a closed form holds."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fem.verification.indentation import DEPTHS, PRESSURE, RADIUS, YOUNGS_MODULUS, settlement
from fem.verification.layered_elasticity import ElasticStack, axis_deflection, surface_response


def stack(thickness, modulus, nu):
    count = len(thickness)
    return ElasticStack(
        np.array(thickness), np.broadcast_to(modulus, count).astype(float), np.broadcast_to(nu, count).astype(float)
    )


@pytest.mark.parametrize("nu", [0.0, 0.35, 0.499])
def test_equal_layers_are_the_half_space(nu):
    found = axis_deflection(stack([*np.diff(DEPTHS), np.inf], YOUNGS_MODULUS, nu), RADIUS, PRESSURE)
    np.testing.assert_allclose(found, settlement(np.array(DEPTHS), nu), rtol=1e-9)


@settings(max_examples=20, deadline=None)
@given(st.floats(0.1, 3.0), st.floats(0.05, 0.95), st.floats(1e-3, 1e3), st.floats(0.0, 0.49))
def test_cutting_a_layer_in_two_changes_nothing(height, share, modulus, nu):
    whole = stack([height, np.inf], [modulus, 1.0], [nu, 0.3])
    cut = stack([share * height, (1 - share) * height, np.inf], [modulus, modulus, 1.0], [nu, nu, 0.3])
    np.testing.assert_allclose(axis_deflection(cut, 1.0, 1.0)[[0, 2]], axis_deflection(whole, 1.0, 1.0), rtol=1e-7)


def test_a_thick_bonded_layer_nears_the_half_space():
    soft = stack([np.inf], 1.0, 0.3)
    gaps = [
        1 - axis_deflection(stack([h], 1.0, 0.3), 1.0, 1.0)[0] / axis_deflection(soft, 1.0, 1.0)[0] for h in (50, 100)
    ]
    assert 0 < gaps[1] < gaps[0] < 0.02
    assert gaps[0] == pytest.approx(2 * gaps[1], rel=0.05)


def test_a_long_wave_squeezes_a_bonded_layer_as_its_oedometer_modulus():
    """Under a pressure that hardly varies w = h / (lambda + 2 G)."""
    nu, k = 0.3, np.array([1e-3])
    oedometer = (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    assert surface_response(stack([2.0], 1.0, nu), k)[0, 0] / k[0] == pytest.approx(2.0 / oedometer, rel=1e-4)


def test_a_very_stiff_base_is_a_rigid_one():
    bonded = axis_deflection(stack([0.7], 1.0, 0.45), 1.0, 1.0)
    on_stiff = axis_deflection(stack([0.7, np.inf], [1.0, 1e7], [0.45, 0.3]), 1.0, 1.0)
    assert on_stiff[0] == pytest.approx(bonded[0], rel=1e-5)


def test_a_layer_that_slides_on_a_very_stiff_base():
    """Without shear at its base: 2 sinh^2(k h) / (sinh(2 k h) + 2 k h) of the half-space's response."""
    nu, k = 0.4, np.linspace(0.2, 5.0, 9)
    body = ElasticStack(np.array([1.0, np.inf]), np.array([1.0, 1e8]), np.array([nu, 0.3]), np.array([True]))
    exact = 2.0 * np.sinh(k) ** 2 / (np.sinh(2.0 * k) + 2.0 * k) * (1.0 - nu) / body.shear_modulus[0]
    np.testing.assert_allclose(surface_response(body, k)[:, 0], exact, rtol=1e-5)
