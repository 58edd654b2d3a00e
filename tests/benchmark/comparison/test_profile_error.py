import numpy as np
import pytest

from benchmark.comparison import ComparisonError, profile_error


def test_percent_of_the_fem_peak():
    error = profile_error([4.0, 2.0, 1.0], [4.2, 2.0, 0.6])
    assert error.maximum_percent == pytest.approx(10.0)
    assert error.index == 2
    assert error.rms_percent == pytest.approx(100 * np.sqrt((0.2**2 + 0.4**2) / 3) / 4.0)


def test_points_outside_the_window_are_left_out():
    error = profile_error([4.0, 2.0, 1.0], [4.0, 2.2, np.nan])
    assert error.maximum_percent == pytest.approx(5.0)
    assert error.points == 2


def test_peak_is_that_of_the_whole_fem_profile():
    assert profile_error([-4.0, 2.0], [np.nan, 2.4]).maximum_percent == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("fem", "wave", "found"),
    [([1.0, 2.0], [np.nan, np.nan], "no common point"), ([0.0, 0.0], [0.0, 1.0], "zero throughout")],
)
def test_nothing_to_relate_to_is_refused(fem, wave, found):
    with pytest.raises(ComparisonError, match=found):
        profile_error(fem, wave)
