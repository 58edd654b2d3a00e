import pytest
from hypothesis import given
from hypothesis import strategies as st

from fem import FemError, LinearElastic, NeoHookean


@pytest.mark.parametrize("law", [LinearElastic, NeoHookean])
@pytest.mark.parametrize("nu", [-1.0, 0.5, 0.49995, float("nan"), 1.0])
def test_poisson_ratio_outside_its_range_is_refused(law, nu):
    with pytest.raises(FemError, match=r"poisson_ratio = .*above -1 and at most 0.4999"):
        law(1e4, nu)


@pytest.mark.parametrize("modulus", [0.0, -1.0, float("inf")])
def test_modulus_must_be_positive(modulus):
    with pytest.raises(FemError, match="youngs_modulus"):
        NeoHookean(modulus, 0.3)


@given(st.floats(1e2, 1e12), st.floats(-0.9, 0.4999))
def test_moduli_satisfy_their_relation(modulus, nu):
    material = NeoHookean(modulus, nu)
    mu, K = material.shear_modulus, material.bulk_modulus
    assert 9.0 * K * mu / (3.0 * K + mu) == pytest.approx(modulus, rel=1e-9)
