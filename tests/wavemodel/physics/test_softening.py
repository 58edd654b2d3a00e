import numpy as np
import pytest
from scipy.special import erf

from wavemodel import WaveError
from wavemodel.physics.body import Physics
from wavemodel.physics.softening import StressSoftening

SOFT = Physics(softening=StressSoftening(0.3, 0.6))


def test_the_first_loading_is_the_base_law(press):
    depth = np.linspace(0.0, 3e-3, 31)
    np.testing.assert_allclose(press(SOFT, depth), 500.0 * depth, rtol=1e-13)


def test_below_the_deepest_depth_it_is_the_law_of_ogden_and_roxburgh(press, path):
    depth = path(0.0, 3e-3, 0.0)
    found, back = press(SOFT, depth), slice(np.argmax(depth), None)
    ratio = (depth[back] / 3e-3) ** 2
    np.testing.assert_allclose(found[back], 500.0 * depth[back] * (1 - 0.3 * erf((1 - ratio) / 0.6)), atol=1e-13)


def test_loading_again_follows_the_way_back_and_then_the_base_law(press, path):
    depth = path(0.0, 3e-3, 0.0, 5e-3, points=801)
    found, top = press(SOFT, depth), int(np.argmax(depth >= 3e-3 - 1e-12))
    down = slice(top, np.argmin(np.where(np.arange(depth.size) > top, depth, 1.0)) + 1)
    up = slice(down.stop - 1, None)
    grid = np.linspace(1e-4, 2.9e-3, 20)
    there = np.interp(grid, depth[down][::-1], found[down][::-1])
    np.testing.assert_allclose(np.interp(grid, depth[up], found[up]), there, rtol=1e-2)
    beyond = depth[up] > 3.05e-3
    np.testing.assert_allclose(found[up][beyond], 500.0 * depth[up][beyond], rtol=1e-13)


def test_off_at_zero(press, path):
    depth = path(0.0, 3e-3, 0.0)
    np.testing.assert_array_equal(press(Physics(softening=StressSoftening(0.0)), depth), 500.0 * depth)


@pytest.mark.parametrize("wrong", [(1.0, 0.5), (-0.1, 0.5), (0.3, 0.0)])
def test_refuses(wrong):
    with pytest.raises(WaveError, match="stress softening"):
        StressSoftening(*wrong)
