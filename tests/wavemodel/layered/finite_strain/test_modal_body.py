import numpy as np
import pytest
from scipy.special import j1

from wavemodel import WaveLayer
from wavemodel.layered.finite_strain.modal_body import disc_modes, thickness_of
from wavemodel.layered.stack.laminate import laminate

MODES = disc_modes(20e-3, 2000.0)


def test_modes_are_orthogonal_and_stay_within_a_wall():
    gram = MODES.level.T @ (MODES.area[:, None] * MODES.level)
    scale = np.sqrt(np.outer(MODES.square, MODES.square))
    np.testing.assert_allclose(gram / scale, np.eye(MODES.square.size), atol=5e-4)
    np.testing.assert_allclose((gram / scale)[:10, :10], np.eye(10), atol=1e-5)
    np.testing.assert_allclose(j1(MODES.wavenumber * 20e-3), 0.0, atol=1e-6)
    np.testing.assert_allclose(MODES.area.sum(), np.pi * 20e-3**2)
    assert MODES.wavenumber[-1] == pytest.approx(2000.0, abs=1.5 * np.pi / 20e-3)


def test_slopes_are_those_of_the_modes():
    """u = -U J_1, w = W J_0: divergence -k J_0 from radial and hoop parts together, and dw/dr = -k J_1."""
    np.testing.assert_allclose(MODES.stretch + MODES.hoop, -MODES.wavenumber * MODES.level, atol=1e-9)
    np.testing.assert_allclose(MODES.slope, MODES.wavenumber * MODES.outward, rtol=1e-12)


def test_functions_through_the_thickness_are_quadratic_from_node_to_node():
    layers = [WaveLayer("a", 1e-3, 1000.0, 1e5, 0.3), WaveLayer("b", 3e-3, 1000.0, 2e4, 0.45)]
    made = thickness_of(laminate(layers, [(1.0,), (0.5, 0.5)], "bonded"))
    node = np.array([0.0, 0.5, 1.0, 1.75, 2.5, 3.25]) * 1e-3
    point = made.shape @ (node - 4e-3) + 4e-3
    square = made.shape @ ((node - 4e-3) ** 2)
    np.testing.assert_allclose(square, (point - 4e-3) ** 2, rtol=1e-12)
    np.testing.assert_allclose(made.slope @ (node - 4e-3), 1.0, rtol=1e-12)
    assert made.weight.sum() == np.float64(4e-3)
    np.testing.assert_allclose(node[made.faces], [0.0, 1e-3])
    np.testing.assert_allclose(made.bulk[0], 1e5 / 3 / (1 - 0.6))


def some(body, size, seed=0):
    """Amplitudes that move the surface by about `size`."""
    out = np.random.default_rng(seed).normal(size=(body.radial.wavenumber.size, 2 * body.nodes))
    return size * out / np.abs(out.sum(axis=0)).max() / (1.0 + np.arange(out.shape[0]))[:, None]


def test_forces_are_the_slope_of_the_energy(small_body):
    amplitude, change = some(small_body, 2e-4), some(small_body, 1e-8, 1)
    forth, back = (small_body.energy(small_body.state(amplitude + s * change)) for s in (1, -1))
    forces = small_body.forces(small_body.state(amplitude).stress)
    assert (forces * change).sum() == pytest.approx((forth - back) / 2, rel=1e-5)


def test_the_tangent_is_symmetric_and_the_slope_of_the_forces(small_body):
    state, a, b = small_body.state(some(small_body, 2e-4)), some(small_body, 1e-4, 1), some(small_body, 1e-4, 2)
    assert (a * small_body.force_change(state, b)).sum() == pytest.approx((b * small_body.force_change(state, a)).sum())
    h = 1e-4
    forth, back = (small_body.forces(small_body.state(some(small_body, 2e-4) + s * h * a).stress) for s in (1, -1))
    expected = (forth - back) / (2 * h)
    np.testing.assert_allclose(small_body.force_change(state, a), expected, atol=1e-6 * np.abs(expected).max())


def test_at_rest_the_tangent_is_the_linear_stiffness_mode_by_mode(small_body):
    rest = small_body.state(np.zeros((small_body.radial.wavenumber.size, 2 * small_body.nodes)))
    change = some(small_body, 1e-4, 3)
    change[0, : small_body.nodes] = 0.0  # the even mode has no in-plane part
    forces = small_body.force_change(rest, change)
    back = np.einsum("nij,nj->ni", small_body.linear_compliance, forces)
    np.testing.assert_allclose(back, change, atol=1e-3 * np.abs(change).max())
    np.testing.assert_allclose(small_body.forces(rest.stress), 0.0, atol=1e-18)
