import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.adhesion import Adhesion
from wavemodel.physics.body import Physics
from wavemodel.physics.pretension import Pretension

DEPTH = np.linspace(0.0, 4e-3, 41)


def test_adds_a_spring(press):
    np.testing.assert_allclose(press(Physics(pretension=Pretension(120.0)), DEPTH), 620.0 * DEPTH, rtol=1e-13)


def test_off_at_zero(press):
    np.testing.assert_array_equal(press(Physics(pretension=Pretension(0.0)), DEPTH), 500.0 * DEPTH)


def test_of_a_membrane_is_the_solution_of_its_equation():
    """T (r w')' = 0 between a and R: the slope at the tool carries the force, 2 pi a T w'(a) = F."""
    k = Pretension.of_membrane(30.0, 5e-3, 30e-3).stiffness
    r = np.geomspace(5e-3, 30e-3, 20001)
    w = np.log(30e-3 / r) / np.log(6.0)
    slope = (w[0] - w[1]) / (r[1] - r[0])
    assert k == pytest.approx(2 * np.pi * 5e-3 * 30.0 * slope, rel=1e-4)


def test_pulls_back_where_the_tool_is_held_but_not_in_air(press):
    depth = np.array([-1e-3, 1e-3, -1e-4])
    held = press(Physics(pretension=Pretension(100.0), adhesion=Adhesion(1.0)), depth)
    np.testing.assert_allclose(held, [0.0, 0.6, -0.06], rtol=1e-12)
    np.testing.assert_allclose(press(Physics(pretension=Pretension(100.0)), depth), [0.0, 0.6, 0.0], rtol=1e-12)


def test_refuses():
    with pytest.raises(WaveError, match="stiffness = -1 N/m"):
        Pretension(-1.0)
    with pytest.raises(WaveError, match="tool radius"):
        Pretension.of_membrane(30.0, 30e-3, 30e-3)
