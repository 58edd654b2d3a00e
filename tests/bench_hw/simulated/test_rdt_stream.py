"""Faults on demand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bench_hw.devices.rdt import parse_records
from bench_hw.errors import InputError
from bench_hw.simulated.rdt_stream import RdtStream, StreamFaults, StreamSettings, parse_positions


@pytest.mark.parametrize(
    ("text", "positions"),
    [("", set()), ("5", {5}), ("200-202,500", {200, 201, 202, 500}), (" 3 , 7-7 ", {3, 7}), ("1,1-2", {1, 2})],
)
def test_positions(text, positions):
    assert parse_positions(text) == positions


@pytest.mark.parametrize("text", ["0", "-3", "5-3", "a", "1-2-3", "1.5", "3-", "1-99999999999"])
def test_what_is_no_position_is_refused(text):
    with pytest.raises(InputError, match="allowed are numbers from 1"):
        parse_positions(text)


@given(st.sets(st.integers(1, 5000), max_size=30))
def test_positions_come_back_as_they_were_written(positions):
    assert parse_positions(",".join(map(str, positions))) == positions


@pytest.mark.parametrize("chance", [-0.1, 1.1, float("nan")])
def test_a_chance_is_between_nought_and_one(chance):
    with pytest.raises(InputError, match="allowed are 0 to 1"):
        StreamFaults(loss=chance)


def measure(instants):
    counts = np.zeros((len(instants), 6), np.int32)
    counts[:, 2] = np.rint(1e6 * instants)
    return counts, np.zeros(len(instants), np.uint32)


def make(faults=None, **options):
    options = {"divider": 7, **options}
    return RdtStream(StreamSettings(**options), 0.0, measure, faults or StreamFaults(), np.random.default_rng(1))


def records(datagrams):
    return np.concatenate([parse_records(data) for data in datagrams]) if datagrams else np.zeros(0)


def test_records_come_at_their_instants():
    stream = make()
    sent = records(stream.due(0.0105))
    assert sent["rdt_sequence"].tolist() == list(range(1, 11))
    assert sent["ft_sequence"].tolist() == [7 * k for k in range(1, 11)]
    assert sent["counts"][:, 2].tolist() == [1000 * k for k in range(1, 11)]
    assert stream.due(0.0105) == []
    assert stream.sent == 10


def test_a_real_rate_is_seven_kilohertz_over_a_whole_number():
    assert len(make(divider=11).due(1.0)) == 636
    assert len(make(divider=1).due(1.0)) == 7000


def test_buffered_datagrams_are_full_and_the_rest_waits():
    stream = make(records_per_datagram=4)
    first, second = stream.due(0.0105), stream.due(0.0135)
    assert [len(data) // 36 for data in first + second] == [4, 4, 4]
    assert records(first + second)["rdt_sequence"].tolist() == list(range(1, 13))


def test_a_counted_stream_ends_with_what_is_left():
    stream = make(records_per_datagram=4, count=6)
    assert [len(data) // 36 for data in stream.due(1.0)] == [4, 2]
    assert stream.finished
    assert stream.due(2.0) == []


def test_the_numbers_wrap():
    assert records(make(first_sequence=2**32 - 2).due(0.0045))["rdt_sequence"].tolist() == [2**32 - 2, 2**32 - 1, 0, 1]


def test_a_pause_delays_without_a_gap():
    stream = make()
    stream.due(0.005)
    stream.pause(1.0)
    assert stream.due(0.9) == []
    assert records(stream.due(1.0075))["rdt_sequence"].tolist() == [6, 7]


def test_restart_and_freeze():
    stream = make()
    stream.due(0.005)
    stream.restart()
    sent = records(stream.due(0.0075))
    assert sent["rdt_sequence"].tolist() == [1, 2]
    assert sent["ft_sequence"].tolist() == [7, 14]
    stream.freeze(True)
    assert set(records(stream.due(0.0105))["ft_sequence"].tolist()) == {14}
    stream.freeze(False)
    assert records(stream.due(0.0115))["ft_sequence"].tolist() == [42]


def test_dropped_doubled_and_late_records():
    faults = StreamFaults(drop=frozenset([2, 3]), duplicate=frozenset([5]), reorder=frozenset([7]))
    stream = make(faults)
    assert records(stream.due(0.0095))["rdt_sequence"].tolist() == [1, 4, 5, 5, 6, 8, 7, 9]
    assert (stream.sent, stream.dropped) == (8, 2)


@settings(max_examples=30)
@given(st.floats(0, 1), st.lists(st.floats(0, 0.2), min_size=1, max_size=12), st.integers(1, 5))
def test_sent_and_dropped_add_up_however_it_is_asked(loss, steps, size):
    stream = make(StreamFaults(loss=loss), records_per_datagram=size)
    now, count = 0.0, 0
    for step in steps:
        now += step
        count += len(records(stream.due(now)))
    produced = int(now * 1000 + 1e-6)
    assert stream.sent + stream.dropped == produced
    assert 0 <= stream.sent - count < size


def test_chance_losses_come_at_their_rate():
    stream = make(StreamFaults(loss=0.01))
    stream.due(60.0)
    assert stream.dropped == pytest.approx(600, abs=100)
