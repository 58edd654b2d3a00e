import pytest

from wavemodel import Damping, WaveError


@pytest.mark.parametrize("values", [(-1.0, 0.0), (0.0, -1e-6), (float("inf"), 0.0), (0.0, float("nan"))])
def test_refuses_negative_and_endless_damping(values):
    with pytest.raises(WaveError, match="damping"):
        Damping(*values)
