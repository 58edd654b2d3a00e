"""Frames are averaged at their own instants."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.trials.rows import (
    EARLIER_ROWS,
    acceleration,
    depth_step,
    earlier_rows,
    frame_means,
    marker_frames,
    no_rows,
    record,
)
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


def test_a_gap_between_rows_is_no_jerk():
    time = np.arange(0.0, 4.0, 0.01)
    depth = 1e-3 * (1.0 - np.cos(time))
    kept = (time < 1.0) | (time > 1.3)
    whole, parted = acceleration(time, depth), acceleration(time[kept], depth[kept])
    np.testing.assert_allclose(whole, 1e-3 * np.cos(time), atol=3e-5)
    np.testing.assert_allclose(parted, whole[kept], atol=3e-5)
    lone = np.flatnonzero((time < 1.0) | ((time > 1.3) & (time < 1.335)) | (time > 1.6))
    assert not acceleration(time[lone], depth[lone])[100:103].any()


def test_a_marker_beyond_the_grid_is_refused():
    camera = Camera(marker_rows=3, marker_columns=2, marker_spacing=6e-3)
    number = np.tile(np.arange(18), 2)
    table = SimpleNamespace(time=np.repeat([0.0, 0.1], 18), marker=number, x=0.001 * number, y=0.0 * number)
    with pytest.raises(InputError, match=r"17 is not in the grid of 3 x 2 .* allowed: 6 numbers"):
        marker_frames(SimpleNamespace(name="t", markers=table), camera)


@pytest.mark.parametrize(("rounding", "scatter", "step"), [(1e-5, 1e-7, 1e-5), (1e-8, 2e-6, 6e-6), (1e-6, 0.0, 1e-6)])
def test_the_smallest_change_of_a_depth_is_its_rounding_or_three_deviations_of_its_scatter(rounding, scatter, step):
    time = np.arange(0.0, 10.0, 0.01)
    depth = 1e-3 * (1.0 - np.cos(0.2 * np.pi * time)) + np.random.default_rng(3).normal(0.0, scatter, time.size)
    assert depth_step(np.round(depth / rounding) * rounding) == pytest.approx(step, rel=0.2)


def test_a_depth_that_stays_has_no_step():
    assert depth_step(np.ones(40)) == 0.0


@pytest.mark.parametrize(("rows", "kept"), [(20_000, 20_000), (20_001, 4)])
def test_a_record_is_whole_unless_it_is_very_long(rows, kept):
    whole = SimpleNamespace(table=SimpleNamespace(time=np.arange(float(rows)), depth=np.arange(float(rows))))
    few = np.array([10.0, 20.0, 30.0, 40.0])
    pieces = (SimpleNamespace(first=0, last=4),)
    raw = SimpleNamespace(trial=whole, time=few, depth=few, pieces=pieces, steadied=False, earlier=no_rows())
    made = record(raw, [(0, np.array([0.0, 0.5, 1.0]))], 10.0)
    assert made.time.size == made.depth.size == kept
    assert made.borders.tolist() == [-5.0, 15.0, 35.0]


def test_a_record_that_scatters_is_not_kept():
    whole = SimpleNamespace(table=SimpleNamespace(time=np.arange(9.0), depth=np.arange(9.0)))
    few = np.array([10.0, 20.0, 30.0, 40.0])
    pieces = (SimpleNamespace(first=0, last=4),)
    raw = SimpleNamespace(trial=whole, time=few, depth=few, pieces=pieces, steadied=True, earlier=no_rows())
    assert record(raw, [(0, np.array([0.0, 0.5, 1.0]))], 10.0).depth.tolist() == few.tolist()


def test_what_a_record_has_before_a_trial_comes_first_and_joins_it():
    whole = SimpleNamespace(table=SimpleNamespace(time=np.arange(20.0, 60.0), depth=np.arange(40.0)))
    few = np.array([20.0, 30.0, 40.0, 50.0])
    earlier = np.array([[6.0, 1.0], [8.0, 1.5], [10.0, 2.0], [12.0, 2.5], [14.0, 3.0]])
    pieces = (SimpleNamespace(first=0, last=4),)
    raw = SimpleNamespace(trial=whole, time=few, depth=few, pieces=pieces, steadied=True, earlier=earlier)
    made = record(raw, [(0, np.array([0.0, 0.5, 1.0]))], 20.0)
    assert made.earlier == 5
    assert made.borders.tolist() == [-15.0, -13.0, -11.0, -9.0, -7.0, -5.0, 15.0, 35.0]
    assert made.depth.tolist() == [1.0, 1.5, 2.0, 2.5, 3.0, *few]
    assert made.interval == 10.0
    assert made.own.borders.tolist() == [-5.0, 15.0, 35.0]
    assert made.own.depth.tolist() == few.tolist()


@pytest.mark.parametrize("presses", [1, 4, 15])
def test_few_rows_of_the_record_before_a_trial_keep_its_turns_and_its_memory(presses):
    """An exponential memory of the depth over the few rows against that over all."""
    knots, depth = [0.0], [-0.3]
    for _ in range(presses):
        knots += (knots[-1] + np.cumsum([1.0, 1.5, 0.6, 1.5])).tolist()
        depth += [-0.3, 3.0, 3.0, -0.3]
    time = np.arange(0.0, knots[-1] + 0.5, 0.01)
    way = np.interp(time, knots, depth)
    before = earlier_rows(time, way)
    assert len(before) <= EARLIER_ROWS + 6 * 4 * presses
    assert before[:, 1].max() == way.max()
    kept = np.interp(time, *before.T)
    for memory in (0.5, 3.0, 20.0):
        fading = np.exp((time - time[-1]) / memory)
        assert np.trapezoid(fading * kept, time) == pytest.approx(np.trapezoid(fading * way, time), abs=0.003 * memory)
