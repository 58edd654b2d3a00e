"""Frames are averaged at their own instants."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.trials.rows import frame_means, marker_frames
from benchmark.errors import InputError
from benchmark.files import Camera


def test_frames_are_averaged_in_their_bin_with_their_own_time():
    frames = np.array([0.01, 0.04, 0.07, 0.31])
    signals = np.array([[1.0], [2.0], [6.0], [8.0]])
    means, counts, moments = frame_means(frames, signals, np.array([0.0, 0.1, 0.2, 0.4]))
    assert counts.tolist() == [3.0, 0.0, 1.0]
    assert means[[0, 2], 0] == pytest.approx([3.0, 8.0])
    assert np.isnan(means[1, 0])
    assert moments == pytest.approx([0.04, 0.15, 0.31])


def test_frames_outside_the_rows_are_left_out():
    frames = np.array([-1.0, 0.05, 9.0])
    means, counts, _ = frame_means(frames, frames[:, None], np.array([0.0, 0.1]))
    assert counts.tolist() == [1.0]
    assert means[0, 0] == pytest.approx(0.05)


def test_a_marker_beyond_the_grid_is_refused():
    camera = Camera(marker_rows=3, marker_columns=2, marker_spacing=6e-3)
    number = np.tile(np.arange(18), 2)
    table = SimpleNamespace(time=np.repeat([0.0, 0.1], 18), marker=number, x=0.001 * number, y=0.0 * number)
    with pytest.raises(InputError, match=r"17 is not in the grid of 3 x 2 .* allowed: 6 numbers"):
        marker_frames(SimpleNamespace(name="t", markers=table), camera)
