import numpy as np
import pytest


def some(body, size, seed=0):
    """Amplitudes that move the surface by about `size`."""
    out = np.random.default_rng(seed).normal(size=(body.modes.wavenumber.size, 2 * body.nodes))
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
    rest = small_body.state(np.zeros((small_body.modes.wavenumber.size, 2 * small_body.nodes)))
    change = some(small_body, 1e-4, 3)
    change[0, : small_body.nodes] = 0.0  # the even mode has no in-plane part
    forces = small_body.force_change(rest, change)
    back = np.einsum("nij,nj->ni", small_body.linear_compliance, forces)
    np.testing.assert_allclose(back, change, atol=1e-3 * np.abs(change).max())
    np.testing.assert_allclose(small_body.forces(rest.stress), 0.0, atol=1e-18)
