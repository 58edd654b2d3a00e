import numpy as np
import pytest
from benchmark.discovery.base_law import BaseLaw
from benchmark.discovery.fem_base import _with_force


def test_the_force_is_the_other_one_and_goes_on_like_the_wave() -> None:
    depth = np.linspace(0.0, 4e-3, 200)
    wave = BaseLaw(depth, 1000.0 * depth, 100.0 * depth, np.array([0.0, 1.0]))
    ramp = np.linspace(0.0, 3e-3, 25)
    law = _with_force(wave, ramp, 1000.0 * ramp + 2e5 * ramp**2)
    inside = (depth > 1e-4) & (depth <= 3e-3)
    assert law.force[inside] == pytest.approx(1000.0 * depth[inside] + 2e5 * depth[inside] ** 2, rel=1e-3)
    assert law.force[-1] == pytest.approx(1.6 * wave.force[-1], rel=1e-2)
    assert law.force_by_radius[-1] == pytest.approx(1.6 * wave.force_by_radius[-1], rel=1e-2)
    assert law.force[0] == 0.0
