import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fem import LinearElastic
from fem.materials.components import AXISYMMETRIC
from fem.materials.deformation import Deformation

MATERIAL = LinearElastic(1e5, 0.3)
PARAMETERS = np.array(MATERIAL.parameters)


@given(st.lists(st.floats(-0.01, 0.01), min_size=5, max_size=5))
def test_stress_is_twice_mu_times_the_deviator(H):
    d = Deformation(AXISYMMETRIC, np.array(H))
    strain = AXISYMMETRIC.tensor(d.small_strain)
    expected = 2 * MATERIAL.shear_modulus * (strain - np.trace(strain) / 3 * np.eye(3))
    np.testing.assert_allclose(AXISYMMETRIC.tensor(MATERIAL.law.stress(d, PARAMETERS)), expected, atol=1e-9)


def test_tangent_times_gradient_is_the_stress():
    d = Deformation(AXISYMMETRIC, np.random.default_rng(4).normal(scale=1e-3, size=(5, 3)))
    tangent = AXISYMMETRIC.unpack(MATERIAL.law.tangent(d, PARAMETERS))
    np.testing.assert_allclose(np.einsum("kmp,mp->kp", tangent, d.H), MATERIAL.law.stress(d, PARAMETERS), atol=1e-9)


def test_it_is_for_small_strain_only():
    assert not MATERIAL.finite_strain
