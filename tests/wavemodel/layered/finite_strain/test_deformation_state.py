import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wavemodel.layered.finite_strain.deformation_state import deformed

MU, K = 2.0, 9.0
SMALL = st.lists(st.floats(-0.3, 0.3), min_size=5, max_size=5).map(lambda v: np.array(v)[:, None])


def state(gradient):
    return deformed(np.asarray(gradient, dtype=float).reshape(5, -1), np.array(MU), np.array(K))


@pytest.mark.parametrize("stretch", [0.6, 0.9, 1.0, 1.7])
def test_equibiaxial_stretch_is_the_closed_form(stretch):
    """F = diag(l, l, m): P_rr = mu J^(-2/3) (l - I1 / (3 l)) + K (J - 1) J / l."""
    m = 0.8
    found = state([stretch - 1, 0, 0, m - 1, stretch - 1])
    volume, first = stretch**2 * m, 2 * stretch**2 + m**2
    shear, pressure = MU * volume ** (-2 / 3), K * (volume - 1) * volume
    expected = [shear * (one - first / (3 * one)) + pressure / one for one in (stretch, m)]
    np.testing.assert_allclose(found.stress[[0, 3, 4], 0], [expected[0], expected[1], expected[0]], atol=1e-14)
    assert found.energy[0] == pytest.approx(0.5 * MU * (volume ** (-2 / 3) * first - 3) + 0.5 * K * (volume - 1) ** 2)


def test_simple_shear_is_the_closed_form():
    """Cauchy's shear stress is mu gamma, and P F' is symmetric."""
    found = state([0, 0.7, 0, 0, 0])
    F, P = found.F[:4, 0].reshape(2, 2), found.stress[:4, 0].reshape(2, 2)
    cauchy = P @ F.T
    assert cauchy[0, 1] == pytest.approx(MU * 0.7)
    assert cauchy[1, 0] == pytest.approx(cauchy[0, 1])


def test_small_strain_is_hooke_s_law():
    eps = 1e-6 * np.array([1.0, 0.4, 0.4, -0.5, 0.3])
    trace = eps[0] + eps[3] + eps[4]
    expected = 2 * MU * eps + (K - 2 * MU / 3) * trace * np.array([1, 0, 0, 1, 1])
    np.testing.assert_allclose(state(eps).stress[:, 0], expected, rtol=1e-5)


@given(SMALL, SMALL)
def test_stress_is_the_slope_of_energy_and_the_tangent_that_of_stress(gradient, change):
    here, h = state(gradient), 1e-6
    forth, back = state(gradient + h * change), state(gradient - h * change)
    power = (here.stress * change).sum()
    assert power == pytest.approx((forth.energy[0] - back.energy[0]) / (2 * h), abs=1e-7)
    np.testing.assert_allclose(here.stress_change(change), (forth.stress - back.stress) / (2 * h), atol=1e-6)


@pytest.mark.parametrize("gradient", [[-1.0, 0, 0, 0, 0], [0, 0, 0, 0, -1.2], [0, 0, 0, -0.97, 0], [np.nan] * 5])
def test_matter_that_is_crushed_or_turned_over_is_no_state(gradient):
    assert state(gradient) is None
