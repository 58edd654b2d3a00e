import numpy as np

from fem.materials.components import AXISYMMETRIC
from fem.materials.deformation import Deformation


def test_measures_agree_with_the_tensor():
    H = np.random.default_rng(3).normal(scale=0.2, size=(5, 4))
    d = Deformation(AXISYMMETRIC, H)
    F = AXISYMMETRIC.tensor(d.F)
    C = F.transpose(0, 2, 1) @ F
    np.testing.assert_allclose(d.J, np.linalg.det(F), rtol=1e-13)
    np.testing.assert_allclose(3.0 + d.first_invariant_change, np.trace(C, axis1=1, axis2=2), rtol=1e-13)
    np.testing.assert_allclose(AXISYMMETRIC.tensor(d.green_strain), 0.5 * (C - np.eye(3)), atol=1e-14)


def test_volume_change_keeps_its_digits_when_tiny():
    H = np.array([1e-13, 0.0, 2e-13, 0.0, -2.5e-13])[:, None]
    np.testing.assert_allclose(Deformation(AXISYMMETRIC, H).volume_change, 0.5e-13, rtol=1e-10)
