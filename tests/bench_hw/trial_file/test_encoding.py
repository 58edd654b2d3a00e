"""Records to message bytes and back."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.trial_file.encoding import (
    decode_depth,
    decode_event,
    decode_force,
    decode_frame,
    encode,
    nanoseconds,
)
from bench_hw.trial_file.records import EventRecord, ForceRecord, FrameRecord, PositionRecord

numbers = st.floats(allow_nan=False, allow_infinity=False)
vectors = st.tuples(numbers, numbers, numbers)
words = st.integers(0, 2**32 - 1)
counts = st.none() | st.tuples(*[st.integers(-(2**31), 2**31 - 1)] * 6)


def test_the_bytes_of_a_force_sample():
    sample = ForceRecord(1.0, 2, 3, 0x80010000, (0.5, -1e-6, 0.1), (0.0, 1.0, -2.5), (500000, -1, 100000, 0, 1, -2))
    assert encode(sample) == (
        1,
        b'{"rdt_sequence":2,"ft_sequence":3,"status":2147549184,"counts":[500000,-1,100000,0,1,-2],'
        b'"force":{"x":0.5,"y":-1e-06,"z":0.1},"torque":{"x":0.0,"y":1.0,"z":-2.5}}',
    )


def test_the_bytes_of_a_picture_are_foxgloves_compressed_image():
    channel, data = encode(FrameRecord(12.000000345, 7, b"\xff\xd8\x00", "jpeg"))
    assert channel == 3
    assert json.loads(data) == {
        "timestamp": {"sec": 12, "nsec": 345},
        "frame_id": "camera",
        "frame": 7,
        "format": "jpeg",
        "data": "/9gA",
    }


def test_the_bytes_of_an_event_are_foxgloves_log():
    channel, data = encode(EventRecord(0.5, "force_limit", 'over "6 N"', "fault"))
    assert channel == 4
    assert json.loads(data) == {
        "timestamp": {"sec": 0, "nsec": 500_000_000},
        "level": 4,
        "message": 'over "6 N"',
        "name": "force_limit",
        "file": "",
        "line": 0,
    }


@given(sequence=words, sample=words, status=words, force=vectors, torque=vectors, raw=counts)
def test_force_comes_back_exactly(sequence, sample, status, force, torque, raw):
    record = ForceRecord(3.5, sequence, sample, status, force, torque, raw)
    assert decode_force(3.5, encode(record)[1]) == record


@given(depth=numbers, raw=st.none() | st.integers(0, 1023), target=st.none() | numbers)
def test_depth_comes_back_exactly(depth, raw, target):
    record = PositionRecord(3.5, depth, raw, target)
    assert decode_depth(3.5, encode(record)[1]) == record


def test_a_position_is_the_message_of_depth_that_earlier_files_have():
    written = encode(PositionRecord(3.5, 1e-3, 512, 2e-3))
    assert written == (2, b'{"depth":0.001,"counts":512,"target":0.002}')


@given(frame=words, data=st.binary(max_size=500), kind=st.sampled_from(["jpeg", "png", "webp"]))
def test_pictures_come_back_exactly(frame, data, kind):
    record = FrameRecord(3.5, frame, data, kind)
    assert decode_frame(3.5, encode(record)[1]) == record


@given(kind=st.text(), message=st.text(), level=st.sampled_from(["info", "warning", "fault"]))
def test_events_come_back_exactly(kind, message, level):
    record = EventRecord(3.5, kind, message, level)
    assert decode_event(3.5, encode(record)[1]) == record


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_null_and_never_a_zero(value):
    data = encode(ForceRecord(0.0, 1, 1, 0, (value, 0.0, 0.0), (0.0, 0.0, value)))[1]
    assert json.loads(data)["force"] == {"x": None, "y": 0.0, "z": 0.0}
    record = decode_force(0.0, data)
    assert math.isnan(record.force[0])
    assert math.isnan(record.torque[2])
    assert math.isnan(decode_depth(0.0, encode(PositionRecord(0.0, value))[1]).depth)


def test_seconds_become_the_nearest_nanosecond():
    assert nanoseconds(0.1) == 100_000_000
    assert nanoseconds(123456.000000001) == 123456_000000001


FORCE = {"rdt_sequence": 1, "ft_sequence": 1, "status": 0, "counts": None}
AXES = {"x": 0.0, "y": 0.0, "z": 0.0}


@pytest.mark.parametrize(
    ("decode", "message"),
    [
        (decode_force, []),
        (decode_force, {**FORCE, "force": AXES, "torque": [1, 2, 3]}),
        (decode_force, {**FORCE, "force": {**AXES, "x": "1"}, "torque": AXES}),
        (decode_force, {**FORCE, "force": {**AXES, "x": 10**400}, "torque": AXES}),
        (decode_force, {**FORCE, "rdt_sequence": "1", "force": AXES, "torque": AXES}),
        (decode_force, {**FORCE, "rdt_sequence": 2**64, "force": AXES, "torque": AXES}),
        (decode_force, {**FORCE, "counts": [1, 2], "force": AXES, "torque": AXES}),
        (decode_depth, {"depth": True, "counts": 1, "target": None}),
        (decode_depth, {"depth": 0.1, "counts": [1], "target": None}),
        (decode_depth, {"depth": 0.1, "counts": 1, "target": "down"}),
        (decode_frame, {"frame": 1, "format": 7, "data": ""}),
        (decode_frame, {"frame": 1.5, "format": "jpeg", "data": ""}),
        (decode_frame, {"frame": 1, "format": "jpeg", "data": [1]}),
        (decode_event, {"name": 1, "message": "a", "level": 2}),
        (decode_event, {"name": "a", "message": "a", "level": [2]}),
    ],
)
def test_records_of_wrong_types_are_no_records(decode, message):
    with pytest.raises((ValueError, KeyError, TypeError)):
        decode(0.0, json.dumps(message).encode())


def test_nesting_without_end_is_no_record():
    with pytest.raises(ValueError, match="nested too deeply"):
        decode_depth(0.0, b"[" * 200_000)
