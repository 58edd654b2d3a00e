"""Numbering frames, finding dropped and frozen ones."""

import pytest

from bench_hw.devices.grabbing import FrameCounter


def numbers(counter, stamps, sequences=None):
    sequences = sequences or [None] * len(stamps)
    return [
        counter.frame(stamp, b"%f" % stamp, "jpeg", sequence).number
        for stamp, sequence in zip(stamps, sequences, strict=True)
    ]


def test_the_cameras_own_numbers_are_believed_whatever_the_times():
    counter = FrameCounter(0.1)
    assert numbers(counter, [0.0, 0.1, 0.5, 0.6], [40, 41, 42, 45]) == [0, 1, 2, 5]
    assert counter.health.dropped == 2


@pytest.mark.parametrize(("gap", "dropped"), [(0.10, 0), (0.149, 0), (0.151, 1), (0.20, 1), (0.29, 2), (0.40, 3)])
def test_without_numbers_a_gap_over_one_and_a_half_periods_is_dropped_frames(gap, dropped):
    counter = FrameCounter(0.1)
    assert numbers(counter, [1.0, 1.0 + gap]) == [0, 1 + dropped]
    assert counter.health.dropped == dropped


def test_two_equal_pictures_in_a_row_are_frozen():
    counter = FrameCounter(0.1)
    for k, data in enumerate([b"a", b"b", b"b", b"b", b"c"]):
        counter.frame(0.1 * k, data, "jpeg")
    assert (counter.health.received, counter.health.frozen) == (5, 2)


def test_numbers_that_go_back_still_increase():
    assert numbers(FrameCounter(0.1), [0.0, 0.1, 0.2], [5, 6, 1]) == [0, 1, 2]
