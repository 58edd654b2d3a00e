"""Long tables to arrays."""

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.tables import MarkerTable
from bench_hw.vision.displacement import deformation_window, displacements, tracks_of


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
