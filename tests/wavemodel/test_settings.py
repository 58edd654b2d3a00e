import pytest

from wavemodel import WaveError
from wavemodel.settings import Settings


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"window": 0.0}, "window = 0 m"),
        ({"modes": 0}, "modes = 0"),
        ({"sublayers": (1, 0, 2)}, "sublayers"),
        ({"modes": 7, "static_correction": True}, "at least 8"),
    ],
)
def test_refuses(options, message):
    with pytest.raises(WaveError, match=message):
        Settings(**options)


@pytest.mark.parametrize(
    ("options", "corrected"),
    [({}, True), ({"modes": 8}, True), ({"modes": 7}, False), ({"modes": 64, "static_correction": False}, False)],
)
def test_the_correction_comes_with_enough_modes(options, corrected):
    assert Settings(**options).corrected is corrected
