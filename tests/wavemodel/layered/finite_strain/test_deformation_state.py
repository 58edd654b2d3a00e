import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wavemodel.layered.finite_strain.deformation_state import LawColumns, deformed

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


class LockingShear:
    """W = mu / 2 x + mu / 2 x^2, x = J^(-2/3) tr C - 3, by complex steps of the energy: no formula of the package."""

    def __init__(self, stiffening=1.0, torn=np.inf):
        self.stiffening, self.torn = stiffening, torn

    def _energy(self, gradient):
        F = gradient + np.array([1.0, 0.0, 0.0, 1.0, 1.0]).reshape(5, *(1,) * (gradient.ndim - 1))
        volume = (F[0] * F[3] - F[1] * F[2]) * F[4]
        x = volume ** (-2.0 / 3.0) * (F * F).sum(axis=0) - 3.0
        return 0.5 * MU * (x + self.stiffening * x * x)

    def energy(self, gradient):
        found = self._energy(gradient).real
        return np.where(found > self.torn, np.nan, found)

    def stress(self, gradient):
        steps = 1e-30j * np.eye(5).reshape(5, 5, *(1,) * (gradient.ndim - 1))
        return np.stack([self._energy(gradient + step).imag / 1e-30 for step in steps])

    def tangent(self, gradient):
        steps = 1e-6 * np.eye(5).reshape(5, 5, *(1,) * (gradient.ndim - 1))
        slopes = [(self.stress(gradient + step) - self.stress(gradient - step)) / 2e-6 for step in steps]
        return np.stack(slopes, axis=1)


def with_law(gradient, law):
    """Two columns of points: the first neo-Hookean, the second by the law."""
    gradient = np.repeat(np.asarray(gradient, dtype=float).reshape(5, 1, 1), 2, axis=2)
    return deformed(gradient, np.array([MU, 0.0]), np.array([K, K]), [LawColumns(slice(1, 2), law)])


@pytest.mark.parametrize("seed", range(4))
def test_a_layer_s_own_law_stands_for_the_neo_hookean_term_on_its_points(seed):
    gradient, change = np.random.default_rng(seed).uniform(-0.3, 0.3, (2, 5, 1))
    found, plain = with_law(gradient, LockingShear(stiffening=0.0)), state(gradient)
    for value in found.energy[0]:
        assert value == pytest.approx(plain.energy[0], abs=1e-12)
    for column in (0, 1):
        np.testing.assert_allclose(found.stress[:, 0, column], plain.stress[:, 0], atol=1e-12)
        turned = found.stress_change(np.repeat(change[:, None], 2, axis=2))[:, 0, column]
        np.testing.assert_allclose(turned, plain.stress_change(change)[:, 0], atol=1e-6)


def test_a_stiffening_law_changes_its_own_points_only():
    found, plain = with_law([0.2, 0.1, 0, -0.1, 0.1], LockingShear()), state([0.2, 0.1, 0, -0.1, 0.1])
    assert found.energy[0, 0] == pytest.approx(plain.energy[0])
    assert found.energy[0, 1] > 1.01 * plain.energy[0]


def test_where_a_law_has_no_answer_there_is_no_state():
    assert with_law([0.2, 0.1, 0, -0.1, 0.1], LockingShear(torn=1e-3)) is None
