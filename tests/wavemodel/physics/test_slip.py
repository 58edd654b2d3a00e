import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.body import Physics
from wavemodel.physics.slip import InterfaceSlip

SLIP = InterfaceSlip(limit=1.0, share=0.4)


def test_sticks_below_its_limit(press):
    depth = np.array([0.0, 5e-4, 1.9e-3, 1e-3, 0.0])
    np.testing.assert_allclose(press(Physics(slip=SLIP), depth), 500.0 * depth, rtol=1e-12, atol=1e-15)


def test_beyond_it_only_the_rest_of_the_stiffness_is_left(press):
    depth = np.linspace(0.0, 6e-3, 61)
    expected = np.where(depth <= 2e-3, 500.0 * depth, 0.6 * 500.0 * depth + 0.4)
    np.testing.assert_allclose(press(Physics(slip=SLIP), depth), expected, rtol=1e-12, atol=1e-15)


def test_a_wide_cycle_loses_what_the_slider_loses(press, path):
    """4 s F_s (swing - what sticks), the slider moving by half the cycle's way less the elastic part, both ways."""
    depth = path(0.0, 20e-3, 10e-3, 20e-3, points=4001)
    force = press(Physics(slip=SLIP), depth)
    cycle = slice(np.argmax(depth), None)
    lost = -np.trapezoid(force[cycle], depth[cycle])
    carried, spring = 0.4 * 1.0, 0.4 * 500.0
    assert -lost == pytest.approx(2.0 * carried * (10e-3 - 2.0 * carried / spring), rel=1e-6)


def test_does_not_depend_on_rate(press, path):
    depth = path(0.0, 6e-3, 1e-3, 4e-3, 0.0)
    np.testing.assert_array_equal(*(press(Physics(slip=SLIP), depth, speed) for speed in (1e-4, 1e-1)))


def test_off_without_a_share(press, path):
    depth = path(0.0, 6e-3, 0.0)
    np.testing.assert_allclose(press(Physics(slip=InterfaceSlip(1.0, 0.0)), depth), 500.0 * depth, atol=1e-15)


def test_from_shear_stress():
    assert InterfaceSlip.at_shear(2e3, 500.0, 0.3) == InterfaceSlip(4.0, 0.3)


@pytest.mark.parametrize("wrong", [(0.0, 0.5), (1.0, 1.1), (1.0, -0.1)])
def test_refuses(wrong):
    with pytest.raises(WaveError, match="interface slip"):
        InterfaceSlip(*wrong)
