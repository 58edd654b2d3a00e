"""The exact bytes of the Net F/T box's RDT protocol."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bench_hw.devices.rdt import (
    MODULUS,
    TICK,
    Command,
    SequenceTracker,
    back_dated,
    describe,
    divider_of,
    is_fault,
    is_saturated,
    parse_records,
    parse_request,
    rate_of,
    request,
)


@pytest.mark.parametrize(
    ("command", "count", "golden"),
    [
        (Command.STOP, 0, "12 34 00 00 00 00 00 00"),
        (Command.START_REALTIME, 0, "12 34 00 02 00 00 00 00"),
        (Command.START_REALTIME, 1, "12 34 00 02 00 00 00 01"),
        (Command.START_BUFFERED, 0, "12 34 00 03 00 00 00 00"),
        (Command.START_BUFFERED, 0x01020304, "12 34 00 03 01 02 03 04"),
        (Command.RESET_LATCH, 0, "12 34 00 41 00 00 00 00"),
        (Command.BIAS, 0, "12 34 00 42 00 00 00 00"),
    ],
)
def test_request_bytes(command, count, golden):
    assert request(command, count) == bytes.fromhex(golden)
    assert parse_request(bytes.fromhex(golden)) == (command, count)


@pytest.mark.parametrize("count", [-1, 2**32])
def test_a_count_that_does_not_fit_is_refused(count):
    with pytest.raises(ValueError, match="sample count"):
        request(Command.STOP, count)


@pytest.mark.parametrize(
    "data", ["", "12 34", "12 35 00 02 00 00 00 00", "12 34 00 09 00 00 00 00", "34 12 02 00 00 00 00 00"]
)
def test_bytes_that_are_no_request(data):
    assert parse_request(bytes.fromhex(data)) is None


RECORD = (
    "00 00 00 05  00 00 00 23  80 01 00 00 "  # rdt_sequence, ft_sequence, status
    "00 0f 42 40  ff f0 bd c0  00 00 00 01  ff ff ff ff  7f ff ff ff  80 00 00 00"  # Fx Fy Fz Tx Ty Tz
)


def test_record_bytes():
    (record,) = parse_records(bytes.fromhex(RECORD))
    assert (record["rdt_sequence"], record["ft_sequence"], record["status"]) == (5, 35, 0x80010000)
    assert record["counts"].tolist() == [1_000_000, -1_000_000, 1, -1, 2**31 - 1, -(2**31)]


def test_a_datagram_of_buffered_mode_holds_several_records():
    records = parse_records(bytes.fromhex(RECORD) * 3)
    assert records["rdt_sequence"].tolist() == [5, 5, 5]


@given(st.binary(max_size=200).filter(lambda data: len(data) % 36 or not data))
def test_any_other_length_is_no_record(data):
    assert parse_records(data) is None


@pytest.mark.parametrize(
    ("asked", "given_"),
    [(7000, 7000), (6000, 7000), (3500, 3500), (3000, 3500), (1000, 1000), (900, 1000), (600, 636), (1, 1)],
)
def test_the_boxs_rule_of_rates(asked, given_):
    assert rate_of(asked) == given_


@given(st.integers(1, 7000))
def test_a_rate_is_never_below_what_was_asked_for_and_stays_when_asked_for_again(asked):
    rate = rate_of(asked)
    assert rate >= asked
    assert rate_of(rate) >= rate
    assert divider_of(rate) == 7000 // asked


@pytest.mark.parametrize("asked", [0, -5, 7001])
def test_other_rates_are_refused(asked):
    with pytest.raises(ValueError, match="1 to 7000"):
        rate_of(asked)


def test_records_are_numbers_of_the_machine_when_converted():
    record = parse_records(bytes.fromhex(RECORD))
    assert record["counts"].astype(np.int32).dtype == np.int32


@pytest.mark.parametrize(
    ("status", "fault", "saturated", "says"),
    [
        (0x00000000, False, False, "healthy"),
        (0x80010000, False, False, "condition latched"),
        (0x80000000, True, False, "an error whose cause is not named"),
        (0x80020000, True, True, "transducer saturated"),
        (0x00020000, True, True, "transducer saturated"),
        (0xC0000000, True, False, "CPU or RAM error"),
        (0x80030000, True, True, "transducer saturated, condition latched"),
        (0x00000100, True, False, "other bits 0x100"),
    ],
)
def test_meaning(status, fault, saturated, says):
    assert (is_fault(status), is_saturated(status), describe(status)) == (fault, saturated, says)


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


def test_the_newest_is_stamped_now_and_the_others_by_their_distance():
    times = back_dated(10.0, -np.inf, np.array([5, 6, 7]), 1e-3)
    assert times == pytest.approx([9.998, 9.999, 10.0], abs=1e-5)


def test_a_gap_stays_a_gap():
    times = back_dated(10.0, -np.inf, np.array([5, 9, 10]), 1e-3)
    assert times == pytest.approx([9.995, 9.999, 10.0], abs=1e-5)


def test_a_late_one_stands_after_those_that_overtook_it():
    times = back_dated(10.0, -np.inf, np.array([5, 7, 6, 8]), 1e-3)
    assert times[2] == pytest.approx(times[1] + TICK, abs=1e-9)


def test_nothing_read_nothing_stamped():
    assert len(back_dated(1.0, 0.5, np.zeros(0, np.int64), 1e-3)) == 0


@given(
    st.lists(st.lists(st.integers(0, 50), min_size=1, max_size=20), min_size=1, max_size=10),
    st.floats(1e-4, 0.1),
    st.floats(0.0, 1e-2),
)
def test_stamps_increase_strictly_within_and_across_calls(calls, period, between):
    previous, now, stamps = -np.inf, 100.0, []
    for offsets in calls:
        times = back_dated(now, previous, np.array(offsets), period)
        stamps += times.tolist()
        previous, now = times[-1], now + between
    assert all(after - before >= 0.5 * TICK for before, after in pairwise(stamps))


@given(st.lists(st.integers(0, 1000), min_size=1, max_size=50, unique=True).map(sorted))
def test_an_orderly_batch_is_never_in_the_future(offsets):
    times = back_dated(5.0, -np.inf, np.array(offsets), 1e-3)
    assert times[-1] <= 5.0 + TICK * len(offsets)
