"""The exact bytes of the Net F/T box's RDT protocol."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.devices.netft_wire import Command, divider_of, parse_records, parse_request, rate_of, request


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
