"""Homogeneous neo-Hookean bodies beyond the gated ones: other ratios, and with and without stabilisation."""

import numpy as np
import pytest

from fem.materials import NeoHookean
from fem.verification.homogeneous import principal_stress, uniaxial


@pytest.mark.parametrize("nu", [0.3, 0.49, 0.4999])
@pytest.mark.parametrize("stretch", [0.5, 0.8, 1.5])
@pytest.mark.parametrize("stabilisation", [0.0, 1.0])
def test_force_and_bulging_are_the_closed_form(nu, stretch, stabilisation):
    for quantity in uniaxial(nu, stretch, stabilisation):
        assert abs(quantity.error_percent) < 1e-7


def test_the_closed_form_is_the_derivative_of_the_energy():
    material, h = NeoHookean(6e4, 0.45), 1e-6

    def energy(a, x):
        volume, invariant = a * a * x, 2 * a * a + x * x
        return (
            0.5 * material.shear_modulus * (volume ** (-2 / 3) * invariant - 3)
            + 0.5 * material.bulk_modulus * (volume - 1) ** 2
        )

    across, along = principal_stress(material, 1.1, 0.9)
    by_a = (energy(1.1 + h, 0.9) - energy(1.1 - h, 0.9)) / (2 * h)
    by_x = (energy(1.1, 0.9 + h) - energy(1.1, 0.9 - h)) / (2 * h)
    np.testing.assert_allclose([2 * across, along], [by_a, by_x], rtol=1e-7)
