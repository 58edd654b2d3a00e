import numpy as np
import pytest

from wavemodel import Prony
from wavemodel.physics.body import Physics
from wavemodel.physics.quasi_static_press import QuasiStaticPress

SERIES = Prony((0.3, 0.2), (0.4, 6.0))


def test_a_ramp_and_hold_is_the_closed_form():
    """F = K v int G over the ramp: (1 - sum g) t + sum g tau (1 - e^(-t / tau)), shifted in the hold."""
    time, ramp, g, tau = np.linspace(0.1, 12.0, 120), 2.0, np.array([0.3, 0.2]), np.array([0.4, 6.0])
    found = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES)).force(time, np.minimum(time, ramp) * 1e-3)
    start, end = np.maximum(time - ramp, 0.0)[:, None], np.minimum(time, ramp)
    fading = (g * tau * (np.exp(-start / tau) - np.exp(-time[:, None] / tau))).sum(axis=1)
    np.testing.assert_allclose(found, 0.5 * (0.5 * end + fading), rtol=1e-12)


def test_forgets():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES))
    time = np.array([1.0, 2.0, 3.0, 300.0, 301.0])
    again = press.force(time, np.array([1e-3, 3e-3, 0.0, 0.0, 1e-3]))
    assert again[-1] == pytest.approx(again[0], rel=1e-12)


def test_a_history_that_begins_at_zero_begins_relaxed():
    held = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES)).force(
        np.array([0.0, 5.0]), np.full(2, 1e-3)
    )
    np.testing.assert_allclose(held, 0.25)


def test_a_tool_lifted_faster_than_the_tissue_follows_is_not_pulled():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES))
    force = press.force(np.array([1.0, 60.0, 60.1, 60.2]), np.array([3e-3, 3e-3, 0.1e-3, 0.1e-3]))
    assert force[1] == pytest.approx(0.75, rel=1e-3)
    np.testing.assert_array_equal(force[2:], 0.0)
