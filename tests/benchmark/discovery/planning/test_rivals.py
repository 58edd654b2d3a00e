import numpy as np
import pytest

from benchmark.discovery.planning.rivals import separation

TIME = np.linspace(0.0, 10.0, 200)
NOISE = np.array([0.1])


def _slope(vector):
    return (vector[0] * TIME + 0.02 * TIME**2)[:, None]


def test_what_the_rival_can_imitate_does_not_count() -> None:
    first = _slope(np.array([1.5]))
    free = separation(first, _slope, np.array([1.0]), np.array([[100.0]]), NOISE, TIME)
    assert free == pytest.approx((0.5 / 10.0) ** 2, rel=0.1)


def test_what_it_cannot_imitate_does() -> None:
    bump = _slope(np.array([1.0])) + np.exp(-((TIME - 5.0) ** 2))[:, None]
    small = separation(bump, _slope, np.array([1.0]), np.array([[100.0]]), NOISE, TIME)
    large = separation(bump, _slope, np.array([1.0]), np.array([[100.0]]), 0.5 * NOISE, TIME)
    assert small > 100.0
    assert large == pytest.approx(4.0 * small, rel=1e-3)


def test_what_the_session_says_of_the_rival_has_its_price() -> None:
    first = _slope(np.array([1.0])) + 0.3 * (TIME**1.5)[:, None]
    loose = separation(first, _slope, np.array([1.0]), np.array([[1.0]]), NOISE, TIME)
    tight = separation(first, _slope, np.array([1.0]), np.array([[1e-6]]), NOISE, TIME)
    assert tight >= loose


def test_a_zero_and_a_gain_of_the_trial_separate_nothing() -> None:
    base = _slope(np.array([1.0]))
    assert separation(1.1 * base + 0.3, _slope, np.array([1.0]), np.array([[1e-6]]), NOISE, TIME) < 1e-3
