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
