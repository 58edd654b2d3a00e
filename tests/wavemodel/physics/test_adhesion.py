import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.adhesion import Adhesion
from wavemodel.physics.body import Physics

STICKY = Physics(adhesion=Adhesion(0.1))


def test_does_not_act_before_touch(press):
    np.testing.assert_array_equal(press(STICKY, np.array([-2e-3, -1e-4, -1e-5])), 0.0)


def test_pulls_until_it_lets_go_and_not_again_until_touch(press):
    depth = np.array([-1e-4, 1e-3, 0.0, -1e-4, -1.9e-4, -2.1e-4, -1e-4, 0.0, -1e-4])
    expected = 500.0 * np.where([0, 1, 1, 1, 1, 0, 0, 1, 1], depth, 0.0)
    np.testing.assert_allclose(press(STICKY, depth), expected, atol=1e-15)


def test_the_largest_pull_is_the_pull_off_force(press, path):
    found = press(STICKY, path(0.0, 3e-3, -1e-3, points=40001))
    assert found.min() == pytest.approx(-0.1, rel=1e-3)
    assert found.min() >= -0.1


def test_off_at_zero(press, path):
    depth = path(0.0, 3e-3, -1e-3, 1e-3)
    np.testing.assert_array_equal(press(Physics(adhesion=Adhesion(0.0)), depth), np.maximum(500.0 * depth, 0.0))


def test_refuses():
    with pytest.raises(WaveError, match="force = -1 N"):
        Adhesion(-1.0)
