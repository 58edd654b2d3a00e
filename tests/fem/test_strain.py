import numpy as np
import pytest

from fem import strain
from fem.components import AXISYMMETRIC


def test_largest_principal_strain_is_the_eigenvalue():
    rng = np.random.default_rng(14)
    values = rng.normal(size=(5, 20))
    values[3] = values[1]
    eigenvalues = np.linalg.eigvalsh(AXISYMMETRIC.tensor(values))
    np.testing.assert_allclose(strain.largest_principal(values), np.abs(eigenvalues).max(axis=1), rtol=1e-12)


def test_uniaxial_strain_is_itself():
    assert strain.largest_principal(np.array([0.0, 0.0, 0.0, 0.0, -0.2])) == pytest.approx(0.2)
