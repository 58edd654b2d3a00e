import numpy as np
import pytest

from wavemodel import Damping, Prony, WaveError


def test_modulus_fades_from_one_to_what_is_left():
    series = Prony((0.3, 0.2), (0.1, 5.0))
    time = np.array([0.0, 0.1, 1e9])
    expected = 0.5 + 0.3 * np.exp(-time / 0.1) + 0.2 * np.exp(-time / 5.0)
    np.testing.assert_allclose(series.modulus(time), expected, rtol=1e-14)
    assert series.long_term == pytest.approx(0.5)


def test_terms_are_ordered_by_rate():
    strength, rate = Prony((0.3, 0.2), (0.1, 5.0)).ordered
    np.testing.assert_allclose([strength, rate], [[0.2, 0.3], [0.2, 10.0]])


@pytest.mark.parametrize(
    ("strength", "time", "message"),
    [
        ((0.3,), (), "1 strengths, 0 times"),
        ((0.0,), (1.0,), r"strength\[0\] = 0"),
        ((0.3,), (-1.0,), r"time\[0\] = -1 s"),
        ((0.6, 0.4), (1.0, 2.0), "together below 1"),
        ((0.3, 0.4), (1.0, 1.0), "no two terms"),
    ],
)
def test_refuses(strength, time, message):
    with pytest.raises(WaveError, match=message):
        Prony(strength, time)


@pytest.mark.parametrize("values", [(-1.0, 0.0), (0.0, -1e-6), (float("inf"), 0.0), (0.0, float("nan"))])
def test_refuses_negative_and_endless_damping(values):
    with pytest.raises(WaveError, match="damping"):
        Damping(*values)
