"""Frames are averaged at their own instants, and a late depth is read between raw rows."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.trials.rows import (
    RawTrial,
    acceleration,
    bin_plan,
    binned,
    depths_before,
    frame_means,
    marker_frames,
)
from benchmark.discovery.trials.segments import segments
from benchmark.errors import InputError
from benchmark.files import Camera
from benchmark.physics.effect import Motion


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


def test_a_gap_between_rows_is_no_jerk():
    time = np.arange(0.0, 4.0, 0.01)
    depth = 1e-3 * (1.0 - np.cos(time))
    kept = (time < 1.0) | (time > 1.3)
    whole, parted = acceleration(time, depth), acceleration(time[kept], depth[kept])
    np.testing.assert_allclose(whole, 1e-3 * np.cos(time), atol=3e-5)
    np.testing.assert_allclose(parted, whole[kept], atol=3e-5)
    lone = np.flatnonzero((time < 1.0) | ((time > 1.3) & (time < 1.335)) | (time > 1.6))
    assert not acceleration(time[lone], depth[lone])[100:103].any()


LATE = 4e-3  # s


@pytest.fixture
def swinging():
    """A press at 1 Hz, 2 mm deep, that ends on its way in; 500 raw rows a second."""

    def made(late=0.0):
        time = np.arange(0.0, 3.3, 0.002)
        depth = 1e-3 * (1.0 - np.cos(2.0 * np.pi * (time - late)))
        return RawTrial(None, time, depth, depth, np.zeros_like(time), None, None, tuple(segments(time, depth)))

    return made


def test_a_late_depth_has_the_means_of_its_own_rows(swinging):
    raw = swinging()
    plan = bin_plan([raw], 60)
    late = replace(raw, depth=swinging(LATE).depth)
    means = binned(late, plan, None, None).rows[:, 1]
    assert np.unique(binned(raw, plan, None, None).count).max() > 4
    rows = binned(raw, plan, None, None).rows
    between = np.interp(rows[:, 0] - LATE, rows[:, 0], rows[:, 1])
    inside = slice(10, -10)
    assert np.abs(between - means)[inside].max() > 1e-6
    read = depths_before(raw, plan, np.array([0.0, LATE]))[1]
    np.testing.assert_allclose(read[inside], means[inside], atol=1e-7)


def test_a_record_that_ends_in_motion_goes_on(swinging):
    raw = swinging()
    early = depths_before(raw, bin_plan([raw], 60), np.array([-LATE, 0.0]))[0]
    assert early[-1] == pytest.approx(swinging(-LATE).depth[-1], abs=1e-6)


def test_between_the_times_before_the_depth_is_even():
    motion = Motion(np.arange(3.0), np.zeros(3), np.zeros(3), (np.array([-1.0, 1.0]), np.array([[2.0] * 3, [4.0] * 3])))
    assert motion.depth_before(0.5) == pytest.approx([3.5] * 3)
    assert motion.depth_before(9.0) == pytest.approx([4.0] * 3)


def test_a_marker_beyond_the_grid_is_refused():
    camera = Camera(marker_rows=3, marker_columns=2, marker_spacing=6e-3)
    number = np.tile(np.arange(18), 2)
    table = SimpleNamespace(time=np.repeat([0.0, 0.1], 18), marker=number, x=0.001 * number, y=0.0 * number)
    with pytest.raises(InputError, match=r"17 is not in the grid of 3 x 2 .* allowed: 6 numbers"):
        marker_frames(SimpleNamespace(name="t", markers=table), camera)
