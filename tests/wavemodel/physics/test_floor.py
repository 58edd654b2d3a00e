import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.body import Physics
from wavemodel.physics.floor import Floor

DEPTH = np.linspace(0.0, 4e-3, 41)


def test_stiffens_beyond_its_depth_only(press):
    found = press(Physics(floor=Floor(2e-3, 5e4)), DEPTH)
    np.testing.assert_allclose(found, 500.0 * DEPTH + 5e4 * np.maximum(DEPTH - 2e-3, 0.0), rtol=1e-13)


def test_off_without_stiffness(press):
    np.testing.assert_array_equal(press(Physics(floor=Floor(2e-3, 0.0)), DEPTH), 500.0 * DEPTH)


@pytest.mark.parametrize("wrong", [(-1e-3, 1.0), (1e-3, -1.0), (1e-3, np.inf)])
def test_refuses(wrong):
    with pytest.raises(WaveError, match="floor"):
        Floor(*wrong)


def test_a_domed_floor_is_met_by_a_power(press) -> None:
    depth = np.array([0.0, 2e-3, 3e-3, 6e-3])
    found = press(Physics(floor=Floor(2e-3, 1e3, 1.5)), depth) - 500.0 * depth
    assert found == pytest.approx([0.0, 0.0, 1.0, 8.0])
