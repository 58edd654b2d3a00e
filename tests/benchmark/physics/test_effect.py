"""A record of the depth is read between the rows that are its means."""

import numpy as np
import pytest

from benchmark.physics import DepthRecord, Motion

LATE = 4e-3  # s
TIME = np.arange(0.0, 3.3, 0.002)
BORDERS = np.concatenate([np.arange(0.0, 1.0, 0.05), np.arange(1.0, 3.2, 0.11)])


def _depth(time):
    """A sinus of 1 Hz, m."""
    return 1e-3 * (1.0 - np.cos(2.0 * np.pi * time))


def _mean(first, last):
    """Of the sinus between two times, m."""
    w = 2.0 * np.pi
    return 1e-3 * (1.0 - (np.sin(w * last) - np.sin(w * first)) / (w * (last - first)))


@pytest.fixture
def record():
    return DepthRecord(TIME, _depth(TIME), BORDERS)


@pytest.mark.parametrize("late", [0.0, LATE, -LATE, 0.03])
def test_means_are_those_of_the_late_record(record, late):
    first, last = BORDERS[2:-1] - late, BORDERS[3:] - late
    np.testing.assert_allclose(record.means(late)[2:], _mean(first, last), atol=2e-8)


def test_means_are_the_same_however_many_others_are_asked_for(record):
    delays = [*np.linspace(-LATE, LATE, 21), LATE, 0.0, -LATE]
    for late in delays:
        np.testing.assert_array_equal(record.means(late), DepthRecord(TIME, _depth(TIME), BORDERS).means(late))


def test_speeds_are_those_in_the_rows(record):
    exact = np.diff(_depth(BORDERS - LATE)) / np.diff(BORDERS)
    np.testing.assert_allclose(record.speeds(LATE)[1:], exact[1:], atol=1e-6)
    between_rows = np.gradient(record.means(LATE), 0.5 * (BORDERS[1:] + BORDERS[:-1]))
    assert np.abs(between_rows - exact).max() > 1e-4


def test_a_row_without_width_has_the_depth_and_the_speed_there():
    still = DepthRecord(TIME, _depth(TIME), np.array([0.2, 0.25, 0.25, 0.3]))
    assert still.means(LATE)[1] == pytest.approx(_depth(0.25 - LATE), rel=1e-4)
    assert still.speeds(LATE)[1] == pytest.approx(2e-3 * np.pi * np.sin(2.0 * np.pi * (0.25 - LATE)), rel=1e-2)


def test_a_record_that_ends_in_motion_goes_on():
    ramp = DepthRecord(TIME, 2e-3 * TIME, np.linspace(TIME[0], TIME[-1], 12))
    np.testing.assert_allclose(ramp.means(-0.1), ramp.means(0.0) + 2e-4, rtol=1e-9)
    np.testing.assert_allclose(ramp.means(0.1), ramp.means(0.0) - 2e-4, rtol=1e-9)
    np.testing.assert_allclose(ramp.speeds(0.1), 2e-3, rtol=1e-9)


def test_delays_add(record):
    middle = 0.5 * (BORDERS[1:] + BORDERS[:-1])
    motion = Motion(middle, record.means(0.0) - 1e-5, np.zeros_like(middle), record)
    np.testing.assert_allclose(motion.before(LATE).depth, record.means(LATE) - 1e-5, atol=1e-15)
    twice = motion.before(LATE).before(LATE)
    np.testing.assert_allclose(twice.depth, motion.before(2.0 * LATE).depth, atol=1e-15)
    np.testing.assert_allclose(twice.speed, record.speeds(2.0 * LATE))


def test_without_a_record_depths_lie_between_the_rows():
    plain = Motion(np.arange(4.0), np.array([0.0, 1.0, 3.0, 3.0]), np.zeros(4))
    np.testing.assert_allclose(plain.before(0.5).depth, [0.0, 0.5, 2.0, 3.0])
    np.testing.assert_allclose(plain.speed, np.gradient(plain.depth, plain.time))
