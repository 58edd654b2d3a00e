import numpy as np
import pytest

from wavemodel.plate.curve import Curve

DEPTH = np.linspace(0.0, 2.0, 30)
CURVE = Curve(DEPTH, DEPTH + DEPTH**3, np.outer(DEPTH, [1.0, 2.0]), DEPTH[:, None] ** 2)


def test_interpolates_and_inverts():
    depth = np.linspace(0.0, 2.0, 101)
    np.testing.assert_allclose(CURVE.force_at(depth), depth + depth**3, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(CURVE.depth_at(CURVE.force_at(depth)), depth, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(CURVE.state_at(0.7), [0.7, 1.4])
    assert CURVE.reach == (2.0, 10.0)


def test_a_pull_mirrors_a_press():
    assert CURVE.force_at(np.array([-1.0])) == pytest.approx([-2.0], rel=1e-6)
    assert CURVE.axis_at(np.array([-1.0]))[0] == pytest.approx(-CURVE.axis_at(np.array([1.0]))[0])
