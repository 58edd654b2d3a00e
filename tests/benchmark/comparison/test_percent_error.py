"""Percent error over steps and over profiles."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.comparison import ComparisonError, percent_error, profile_error


def test_signed_by_step_absolute_in_the_summary():
    error = percent_error([1.0, 2.0, 4.0], [1.1, 1.8, 4.0])
    assert error.signed == pytest.approx([10.0, -10.0, 0.0])
    assert error.mean == pytest.approx(20.0 / 3.0)
    assert error.maximum == pytest.approx(10.0)
    assert error.at_peak == pytest.approx(0.0)
    assert error.steps == 3


def test_no_percentage_where_unloaded(triangle):
    error = percent_error(triangle, 0.9 * triangle + 1e-9)
    assert np.isnan(error.signed[-1])
    assert error.steps == 99
    noisy = triangle.copy()
    noisy[-1] = 1e-17  # what a solver leaves at zero load
    assert np.isnan(percent_error(noisy, triangle).signed[-1])


def test_zero_load_counts_as_unloaded_even_with_a_deflection():
    error = percent_error([1.0, 2.0, 0.5], [1.0, 2.0, 0.6], load=[1.0, 2.0, 0.0])
    assert np.isnan(error.signed[2])
    assert error.maximum == 0.0


def test_peak_is_the_largest_magnitude_whatever_the_sign():
    assert percent_error([-1.0, -3.0, 2.0], [-1.0, -3.3, 2.0]).at_peak == pytest.approx(10.0)


def test_missing_values_have_no_percentage(triangle):
    wave = np.where(np.arange(100) < 60, triangle, np.nan)
    assert percent_error(triangle, wave).steps == 60
    nothing = percent_error(triangle, np.full(100, np.nan))
    assert nothing.steps == 0
    assert nothing.to_dict()["mean"] is None
    assert percent_error(np.full(5, np.nan), np.ones(5)).steps == 0


def test_load_of_another_length_is_refused(triangle):
    with pytest.raises(ComparisonError, match="load has shape"):
        percent_error(triangle, triangle, load=[1.0])


@given(st.floats(-0.9, 10.0), st.floats(1e-6, 1e3))
def test_a_scale_error_is_found_at_any_scale(scale_error, size):
    fem = size * np.array([0.1, 1.0, 3.0])
    error = percent_error(fem, (1.0 + scale_error) * fem)
    assert error.signed == pytest.approx(np.full(3, 100.0 * scale_error), abs=1e-8)
    assert error.mean == pytest.approx(100.0 * abs(scale_error), abs=1e-8)


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
