import numpy as np
import pytest


@pytest.mark.parametrize("contact", ["rigid_bonded", "rigid_frictionless", "uniform_pressure"])
def test_jacobian_is_symmetric_and_the_derivative_of_the_residual(pressed_sheet, contact):
    sheet = pressed_sheet(contact)
    rng, n = np.random.default_rng(4), sheet.functions.unknowns
    state = np.concatenate([2e-4 * rng.normal(size=n) / (1 + np.arange(n)), rng.normal(size=sheet.unknowns - n)])
    _residual, jacobian = sheet.residual(state, 1e-3, 0.5)
    direction = rng.normal(size=state.size) * np.where(np.arange(state.size) < n, 1e-5, 1.0)
    change = 1e-5 * direction
    slope = (sheet.residual(state + change, 1e-3, 0.5)[0] - sheet.residual(state - change, 1e-3, 0.5)[0]) / 2e-5
    np.testing.assert_allclose(jacobian @ direction, slope, atol=1e-6 * np.abs(slope).max())
    np.testing.assert_allclose(jacobian, jacobian.T, atol=1e-9 * np.abs(jacobian).max())


def test_rest_is_in_equilibrium(pressed_sheet):
    for contact in ("rigid_bonded", "uniform_pressure"):
        sheet = pressed_sheet(contact)
        np.testing.assert_allclose(sheet.residual(np.zeros(sheet.unknowns), 0.0, 0.0)[0], 0.0, atol=1e-12)
