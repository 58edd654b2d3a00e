import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wavemodel.plate.neo_hookean import plane_stress, thickness_stretch

STRETCH = st.floats(0.7, 1.6)


@settings(max_examples=60, deadline=None)
@given(STRETCH, STRETCH, st.sampled_from([0.0, 1.0, 50.0]))
def test_no_stress_across_and_stresses_are_derivatives(l1, l2, lame):
    shear, step = 1.0, 1e-6
    a, b = np.array([l1]), np.array([l2])
    l3 = float(thickness_stretch(a * b, shear, lame)[0])
    assert shear * (l3**2 - 1) + lame * np.log(l1 * l2 * l3) == pytest.approx(0.0, abs=1e-9)
    law = plane_stress(a, b, shear, lame)
    up, down = plane_stress(a + step, b, shear, lame), plane_stress(a - step, b, shear, lame)
    assert (up.energy - down.energy) / (2 * step) == pytest.approx(law.first, rel=1e-5, abs=1e-6)
    assert (up.first - down.first) / (2 * step) == pytest.approx(law.first_first, rel=1e-5)
    assert (up.second - down.second) / (2 * step) == pytest.approx(law.first_second, rel=1e-5, abs=1e-6)
    mirrored = plane_stress(b, a, shear, lame)
    assert mirrored.second == pytest.approx(law.first, abs=1e-12)
    assert mirrored.second_second == pytest.approx(law.first_first)


def test_small_strain_is_hooke_in_plane_stress():
    e, nu = 1.0, 0.3
    shear, lame = e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu))
    law = plane_stress(np.ones(1), np.ones(1), shear, lame)
    assert law.first_first == pytest.approx(e / (1 - nu**2))
    assert law.first_second == pytest.approx(nu * e / (1 - nu**2))
    assert (law.energy[0], law.first[0]) == pytest.approx((0.0, 0.0))


def test_incompressible_equibiaxial_tension_in_closed_form():
    """P = 2 C10 (l - l^-5), C10 = G / 2."""
    law = plane_stress(np.array([1.4]), np.array([1.4]), 1.0, 1e6)
    assert law.first == pytest.approx(1.4 - 1.4**-5, rel=1e-5)
