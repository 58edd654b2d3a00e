"""Counting lost, late, repeated and restarted records."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bench_hw.devices.sequence import MODULUS, SequenceTracker


def feed(tracker, numbers, divider=7, samples=None):
    rdt = np.array([number % MODULUS for number in numbers], np.uint32)
    ft = np.array([(number * divider) % MODULUS for number in (samples or numbers)], np.uint32)
    return tracker.accept(rdt, ft)


def counts(tracker):
    health = tracker.health
    return health.received, health.lost, health.duplicates, health.reordered, health.restarts


def test_a_plain_stream_loses_nothing():
    tracker = SequenceTracker()
    feed(tracker, range(1, 50))
    feed(tracker, range(50, 101))
    assert counts(tracker) == (100, 0, 0, 0, 0)


def test_gaps_are_counted_by_their_size():
    tracker = SequenceTracker()
    feed(tracker, [1, 2, 5, 6, 10])
    assert counts(tracker) == (5, 5, 0, 0, 0)


def test_a_late_record_is_reordered_and_no_longer_lost():
    tracker = SequenceTracker()
    keep, unwrapped = feed(tracker, [1, 2, 4, 3, 5])
    assert keep.all()
    assert unwrapped.tolist() == [1, 2, 4, 3, 5]
    assert counts(tracker) == (5, 0, 0, 1, 0)


def test_duplicates_are_dropped_also_when_they_come_late():
    tracker = SequenceTracker()
    keep, _ = feed(tracker, [1, 2, 2, 3, 1, 4])
    assert keep.tolist() == [True, True, False, True, False, True]
    assert counts(tracker) == (4, 0, 2, 0, 0)


def test_the_wrap_is_no_loss():
    tracker = SequenceTracker()
    numbers = list(range(MODULUS - 3, MODULUS + 4))
    _, unwrapped = feed(tracker, numbers[:2])
    _, more = feed(tracker, numbers[2:])
    assert np.diff(np.concatenate([unwrapped, more])).tolist() == [1] * 6
    assert counts(tracker) == (7, 0, 0, 0, 0)


def test_loss_and_reordering_across_the_wrap():
    tracker = SequenceTracker()
    feed(tracker, [MODULUS - 2, MODULUS + 1, MODULUS - 1, MODULUS + 2])
    assert counts(tracker) == (4, 1, 0, 1, 0)


def test_a_duplicate_from_before_the_wrap():
    tracker = SequenceTracker()
    feed(tracker, [MODULUS - 2, MODULUS - 1, MODULUS, MODULUS - 1])
    assert counts(tracker) == (3, 0, 1, 0, 0)


def test_a_counter_that_begins_anew_is_a_restart_and_no_loss():
    tracker = SequenceTracker()
    feed(tracker, range(1, 1001))
    keep, unwrapped = feed(tracker, [1, 2, 3])
    assert keep.all()
    assert unwrapped.tolist() == [1001, 1002, 1003]
    assert counts(tracker) == (1003, 0, 0, 0, 1)


def test_an_early_restart_is_known_by_its_newer_samples():
    tracker = SequenceTracker()
    feed(tracker, range(1, 21))
    feed(tracker, [1, 2], samples=[30, 31])
    assert counts(tracker) == (22, 0, 0, 0, 1)


def test_samples_that_stand_still_are_stalls():
    tracker = SequenceTracker()
    feed(tracker, [1, 2, 3, 4], samples=[1, 2, 2, 2])
    assert tracker.health.stalls == 2
    assert tracker.health.lost == 0


def test_samples_that_go_back_are_a_restart_of_the_sensor():
    tracker = SequenceTracker()
    feed(tracker, [1, 2, 3], samples=[100, 101, 1])
    assert tracker.health.restarts == 1


def test_samples_wrap_without_a_word():
    tracker = SequenceTracker()
    top = MODULUS // 7
    feed(tracker, range(1, 11), samples=range(top - 5, top + 5))
    assert counts(tracker) == (10, 0, 0, 0, 0)
    assert tracker.health.stalls == 0


@settings(max_examples=150)
@given(
    st.integers(0, MODULUS - 1),
    st.lists(st.sampled_from(["good", "lost", "double", "late"]), min_size=1, max_size=120),
    st.integers(1, 17),
)
def test_counts_equal_what_was_done_to_the_stream(first, fates, batch):
    """Whatever is lost, doubled or swapped with its follower, in batches of any size, near the wrap or not."""
    arriving, held, lost, doubled, late = [first], None, 0, 0, 0
    last = first
    for number, fate in enumerate(fates, start=first + 1):
        if fate == "lost":
            lost += 1
            continue
        if fate == "late" and held is None:
            held = number
            continue
        arriving.append(number)
        last = number
        if fate == "double":
            arriving.append(number)
            doubled += 1
        if held is not None:
            arriving.append(held)
            late, held = late + 1, None
    lost += held is not None
    lost_after_the_last = sum(number > last for number in range(first + 1, first + len(fates) + 1))
    tracker = SequenceTracker()
    for start in range(0, len(arriving), batch):
        feed(tracker, arriving[start : start + batch], divider=1)
    received = len(set(arriving))
    assert counts(tracker) == (received, lost - lost_after_the_last, doubled, late, 0)


def test_malformed_datagrams_are_not_this_counters_business():
    assert SequenceTracker().health.malformed == 0


@pytest.mark.parametrize("gap", [2, 255, 256, 257, 2**31 - 1])
def test_gaps_of_any_size_below_half_the_range(gap):
    tracker = SequenceTracker()
    feed(tracker, [1, 1 + gap], divider=1)
    assert tracker.health.lost == gap - 1
