import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fem import NeoHookean
from fem.materials.components import AXISYMMETRIC
from fem.materials.deformation import Deformation
from fem.materials.neo_hookean import NeoHookeanLaw

LAW, MU = NeoHookeanLaw(), np.array([3.0e4])
gradients = st.lists(st.floats(-0.35, 0.35), min_size=5, max_size=5)


def stress(H):
    return LAW.stress(Deformation(AXISYMMETRIC, np.asarray(H, dtype=float)), MU)


def energy(H):
    d = Deformation(AXISYMMETRIC, np.asarray(H, dtype=float))
    return MU[0] / 2 * (d.isochoric_factor * (3 + d.first_invariant_change) - 3)


@given(gradients)
@settings(max_examples=50, deadline=None)
def test_stress_is_the_derivative_of_the_energy(H):
    step = 1e-5
    slope = [(energy(H + e) - energy(H - e)) / (2 * step) for e in step * np.eye(5)]
    np.testing.assert_allclose(stress(H), slope, atol=2e-5 * MU[0])


@given(gradients)
@settings(max_examples=50, deadline=None)
def test_tangent_is_the_derivative_of_the_stress(H):
    step = 1e-5
    tangent = AXISYMMETRIC.unpack(LAW.tangent(Deformation(AXISYMMETRIC, np.array(H)), MU))
    columns = [(stress(H + e) - stress(H - e)) / (2 * step) for e in step * np.eye(5)]
    scale = np.abs(tangent).max()
    np.testing.assert_allclose(tangent / scale, np.array(columns).T / scale, atol=1e-7)


@given(gradients)
@settings(max_examples=30, deadline=None)
def test_stress_turns_with_the_body(H):
    """P(Q F) = Q P(F) for a turn Q in the r-z plane."""
    c, s = np.cos(0.7), np.sin(0.7)
    Q = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    F = AXISYMMETRIC.tensor(np.array(H) + AXISYMMETRIC.identity)
    turned = [(Q @ F)[i, j] for i, j in AXISYMMETRIC.positions] - AXISYMMETRIC.identity
    np.testing.assert_allclose(
        AXISYMMETRIC.tensor(stress(turned)), Q @ AXISYMMETRIC.tensor(stress(H)), atol=1e-9 * MU[0]
    )


def test_no_stress_at_rest():
    assert np.abs(stress(np.zeros(5))).max() == 0.0


@pytest.mark.parametrize("stretch", [0.5, 0.8, 1.3, 2.0])
def test_incompressible_uniaxial_stress(stretch):
    """P_zz - P_rr F_rr / F_zz = mu (stretch - stretch^-2) (Treloar)."""
    side = stretch**-0.5
    P = stress([side - 1, 0.0, side - 1, 0.0, stretch - 1])
    assert P[4] - P[0] * side / stretch == pytest.approx(MU[0] * (stretch - stretch**-2), rel=1e-12)


@pytest.mark.parametrize("stretch", [0.7, 1.4])
def test_incompressible_equibiaxial_stress(stretch):
    """P_rr with P_zz = 0 is mu (stretch - stretch^-5) (Treloar)."""
    height = stretch**-2
    P = stress([stretch - 1, 0.0, stretch - 1, 0.0, height - 1])
    assert P[0] - P[4] * height / stretch == pytest.approx(MU[0] * (stretch - stretch**-5), rel=1e-12)


def test_simple_shear_stress():
    """Shear stress mu gamma, exactly linear."""
    assert stress([0.0, 0.6, 0.0, 0.0, 0.0])[1] == pytest.approx(MU[0] * 0.6, rel=1e-12)


def test_tiny_strain_keeps_its_digits():
    H = 1e-12 * np.array([1.0, 0.5, -0.4, 0.3, -0.8])
    linear = 2 * MU[0] * AXISYMMETRIC.unpack(AXISYMMETRIC.deviator) @ H
    np.testing.assert_allclose(stress(H), linear, rtol=1e-9)


def test_material_gives_its_shear_modulus_to_the_law():
    material = NeoHookean(3e4, 0.5 - 1e-3)
    assert material.parameters == (material.shear_modulus,)
    assert material.finite_strain
