"""Rate, jitter, gaps and losses of one channel."""

import numpy as np
import pytest

from bench_hw.trial_file.channel_report import report_channel


def test_an_empty_channel_has_no_figures():
    report = report_channel(np.zeros(0), np.zeros(0, dtype=np.int64))
    assert report.rows == 0
    assert report.to_dict()["first_time_s"] is None
    assert report.rate is None


def test_one_row_has_a_time_and_no_rate():
    report = report_channel(np.array([2.5]), np.array([9]))
    assert (report.rows, report.first_time, report.last_time) == (1, 2.5, 2.5)
    assert (report.rate, report.jitter, report.longest_interval) == (None, None, None)


def test_lost_records_do_not_lower_the_rate_of_the_device():
    number = np.delete(np.arange(1000), [200, 201, 202, 500])
    report = report_channel(number / 1000.0, number)
    assert (report.lost, report.gaps, report.reordered) == (4, 2, 0)
    assert report.rate == pytest.approx(1000.0)
    assert report.longest_interval == pytest.approx(0.004)


def test_jitter_is_the_spread_of_intervals_between_neighbours():
    number = np.arange(5000)
    noise = np.random.default_rng(3).normal(0.0, 1e-4, 5000)
    report = report_channel(number / 100.0 + noise, number)
    assert report.jitter == pytest.approx(np.sqrt(2) * 1e-4, rel=0.05)


def test_a_pause_without_a_number_skipped_is_a_gap_but_nothing_lost():
    number = np.arange(1000)
    time = number / 1000.0 + np.where(number >= 400, 0.06, 0.0)
    report = report_channel(time, number)
    assert (report.lost, report.gaps) == (0, 1)
    short = report_channel(number / 1000.0 + np.where(number >= 400, 0.03, 0.0), number)
    assert short.gaps == 0


def test_a_camera_that_does_not_say_so_is_found_to_drop_frames():
    frame = np.arange(90)
    time = (frame + np.where(frame >= 40, 2, 0) + np.where(frame >= 70, 1, 0)) / 30.0
    silent = report_channel(time, frame, camera=True)
    assert (silent.lost, silent.gaps) == (3, 2)
    honest = report_channel(time, np.rint(time * 30).astype(np.int64), camera=True)
    assert (honest.lost, honest.gaps) == (3, 2)


def test_late_records_are_not_lost():
    number = np.arange(100)
    number[[50, 51]] = number[[51, 50]]
    report = report_channel(np.arange(100) / 100.0, number)
    assert (report.lost, report.reordered, report.gaps) == (0, 1, 0)


def test_a_restart_is_counted_and_the_rate_stays_sound():
    number = np.concatenate([np.arange(5000, 5500), np.arange(1, 501)])
    report = report_channel(np.arange(1000) / 1000.0, number)
    assert (report.restarts, report.lost) == (1, 0)
    assert report.rate == pytest.approx(1000.0)


def test_a_frame_that_came_late_is_not_lost():
    time = np.arange(60) / 30
    time[20] += 0.7 / 30
    late = report_channel(time, np.arange(60), camera=True)
    assert (late.lost, late.gaps) == (0, 0)
    dropped = report_channel(np.delete(time, 40), np.arange(59), camera=True)
    assert (dropped.lost, dropped.gaps) == (1, 1)
