import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wavemodel import WaveLayer
from wavemodel.sheet.section import section
from wavemodel.sheet.strain_energy import energy_density, plane_stress, thickness_stretch, vertical_span

SHEET = section([WaveLayer("a", 0.4, 1.0, 2.0, 0.3), WaveLayer("b", 0.6, 1.0, 1.0, 0.49)])
RADIUS = np.linspace(1.0, 3.0, 4)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 1000), st.sampled_from([0.0, 0.7]))
def test_derivatives_are_those_of_the_value(seed, pretension):
    strain = 0.2 * np.random.default_rng(seed).uniform(-1, 1, size=(5, 4))
    functions = (
        lambda x: energy_density(SHEET, RADIUS, x, pretension),
        lambda x: vertical_span(SHEET.thinning, RADIUS, x),
    )
    for function in functions:
        here = function(strain)
        for i in range(5):
            step = np.zeros_like(strain)
            step[i] = 1e-6
            up, down = function(strain + step), function(strain - step)
            np.testing.assert_allclose((up.value - down.value) / 2e-6, here.gradient[i], atol=1e-8)
            np.testing.assert_allclose((up.gradient - down.gradient) / 2e-6, here.hessian[:, i], atol=1e-7)


def test_small_strain_is_reissner_s_plate():
    along, ring, fall, turn, bend = 1e-6 * np.array([1.0, 2.0, -3.0, 0.5, 1.5])
    one = section([WaveLayer("a", 1.0, 1.0, 1.0, 0.3)])
    density = energy_density(one, np.array([2.0]), np.array([[along], [ring], [fall], [turn], [bend]]))
    stretched = along**2 + ring**2 + 0.6 * along * ring
    bent = bend**2 + (turn / 2) ** 2 + 0.6 * bend * turn / 2
    expected = 0.5 * (one.membrane * stretched + one.bending * bent + one.shear * (turn + fall) ** 2)
    assert density.value[0] == pytest.approx(expected, rel=1e-5)


def test_rigid_rotation_costs_nothing_but_the_hoop():
    """The strip turned by phi as a whole: no stretch along, no shear."""
    phi = 0.6
    strain = np.array([[np.cos(phi) - 1], [0.0], [-np.sin(phi)], [phi], [0.0]])
    density = energy_density(SHEET, np.array([1e9]), strain)
    assert density.value[0] == pytest.approx(0.0, abs=1e-12)


def test_pretension_works_on_slopes_only():
    slope = np.array([[0.0], [0.0], [1e-3], [-1e-3], [0.0]])
    without, tense = (energy_density(SHEET, np.array([2.0]), slope, t) for t in (0.0, 5.0))
    assert tense.value[0] - without.value[0] == pytest.approx(0.5 * 5.0 * 1e-6, rel=1e-3)
    flat = energy_density(SHEET, np.array([2.0]), np.zeros((5, 1)), 5.0)
    np.testing.assert_allclose(flat.gradient, 0.0, atol=1e-12)


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
