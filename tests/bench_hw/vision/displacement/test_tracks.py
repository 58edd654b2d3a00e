"""Long tables to arrays."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.signal import lfilter

from bench_hw.errors import InputError
from bench_hw.tables import MarkerTable
from bench_hw.vision.displacement import deformation_window, displacements, fit_parabolas, moving_average, tracks_of


def table() -> MarkerTable:
    """Three frames of two markers; marker 1 is not seen in the second."""
    time = np.array([0.0, 0.0, 0.1, 0.2, 0.2])
    marker = np.array([0, 1, 0, 0, 1])
    x = np.array([1.0, 2.0, 1.1, 1.3, 2.2])
    return MarkerTable(time, marker, x, -x, "test")


def test_missing_sightings_are_nan():
    tracks = tracks_of(table())
    assert np.allclose(tracks.time, [0.0, 0.1, 0.2])
    assert np.allclose(tracks.places[:, :, 0], [[1, 2], [1.1, np.nan], [1.3, 2.2]], equal_nan=True)
    assert np.allclose(tracks.places[:, :, 1], -tracks.places[:, :, 0], equal_nan=True)
    assert tracks_of(table(), 4).places.shape == (3, 4, 2)
    with pytest.raises(InputError, match="marker 1; allowed: 0 to 0"):
        tracks_of(table(), 1)


def test_displacements_count_from_where_each_was_first_seen():
    places = tracks_of(table(), 3).places
    places[0, 1] = np.nan
    moved = displacements(places)
    assert np.allclose(moved[:, 0, 0], [0, 0.1, 0.3])
    assert np.allclose(moved[:, 1, 0], [np.nan, np.nan, 0.0], equal_nan=True)
    assert np.isnan(moved[:, 2]).all()
    assert np.allclose(displacements(places, np.zeros((3, 2)))[0, 0], [1.0, -1.0])


def test_the_window_is_from_the_first_to_the_last_deformed_frame():
    size = np.array([0.0, 0.01, 0.2, np.nan, 1.0, 0.3, 0.04, 0.0])
    assert deformation_window(size) == slice(2, 6)
    assert deformation_window(size, 0.5) == slice(4, 5)
    assert deformation_window(np.full(4, np.nan)) == slice(0, 0)
    assert deformation_window(np.zeros(4)) == slice(0, 0)


values = arrays(np.float64, st.tuples(st.integers(1, 40), st.just(2)), elements=st.floats(-1e3, 1e3))


@given(values, st.integers(1, 12))
def test_the_causal_one_is_the_papers_filter(x, window):
    assert np.allclose(moving_average(x, window, "causal"), lfilter(np.ones(window) / window, 1, x, axis=0), atol=1e-9)


@given(values, st.integers(1, 12), st.floats(-5, 5), st.floats(-5, 5))
def test_the_centred_one_keeps_straight_lines_and_their_times(x, window, slope, start):
    line = (start + slope * np.arange(len(x)))[:, None] * np.ones(2)
    assert np.allclose(moving_average(line, window), line, atol=1e-9)
    assert np.allclose(moving_average(x[::-1], window)[::-1], moving_average(x, window), atol=1e-9)


@given(values)
def test_none_is_nothing(x):
    assert np.array_equal(moving_average(x, 10, "none"), x)
    assert np.array_equal(moving_average(x, 1, "causal"), x)


def test_the_papers_filter_spoils_a_perfect_parabola_and_delays_its_peak():
    """Over 90 frames r2 falls to 0.9926 and the peak comes 4.5 frames late; the centred average does neither."""
    frames = np.arange(90.0)
    parabola = 1 - ((frames - 44.5) / 44.5) ** 2
    late = moving_average(parabola, 10, "causal")
    assert fit_parabolas(frames, late).r2 == pytest.approx(0.9926, abs=0.0003)
    assert np.argmax(late) - 44.5 == pytest.approx(4.5, abs=0.5)
    still = moving_average(parabola, 10, "centred")
    assert fit_parabolas(frames, still).r2 > 0.9999
    assert abs(np.argmax(still) - 44.5) <= 0.5


def test_a_gap_stays_a_gap():
    x = np.arange(30.0)
    x[12] = np.nan
    assert np.flatnonzero(np.isnan(moving_average(x, 5, "causal"))).tolist() == [12, 13, 14, 15, 16]
    assert np.flatnonzero(np.isnan(moving_average(x, 5))).tolist() == [10, 11, 12, 13, 14]


def test_other_windows_and_modes_are_refused():
    with pytest.raises(InputError, match="at least 1"):
        moving_average(np.zeros(3), 0)
    with pytest.raises(InputError, match="allowed: none, centred, causal"):
        moving_average(np.zeros(3), 3, "late")
