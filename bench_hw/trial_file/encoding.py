"""The channels of a trial file, their JSON schemas, and records to message bytes and back.

Pictures and events follow Foxglove's well-known schemas, so that Foxglove shows them; force and depth have schemas of
their own, raw counts beside SI values. Every message is one JSON object in UTF-8. A number that is not finite is
written as `null` and read as NaN: JSON has no NaN, and a zero would be wrong.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from bench_hw.trial_file.records import EventRecord, ForceRecord, FrameRecord, Level, PositionRecord, Vector

_INTEGER = {"type": "integer"}
_NUMBER = {"type": ["number", "null"]}
_TIME = {"type": "object", "title": "time", "properties": {"sec": _INTEGER, "nsec": _INTEGER}}
_AXES = {"type": "object", "properties": {"x": _NUMBER, "y": _NUMBER, "z": _NUMBER}}
Record = ForceRecord | PositionRecord | FrameRecord | EventRecord
NANOSECONDS = 1_000_000_000
_LEVELS: dict[Level, int] = {"info": 2, "warning": 3, "fault": 4}
_LEVEL_NAMES: dict[int, Level] = {number: name for name, number in _LEVELS.items()}


@dataclass(frozen=True)
class ChannelInfo:
    """A channel as the file defines it.

    Parameters
    ----------
    topic : str
        Name of the channel in the file, `/force`.
    schema_name : str
        Name of its schema, `foxglove.Log`.
    schema_data : bytes
        The schema itself.
    schema_encoding, message_encoding : str
        `jsonschema` and `json` for everything this bench writes.
    metadata : tuple of (str, str)
        Whatever else a file says about the channel.
    """

    topic: str
    schema_name: str
    schema_data: bytes
    schema_encoding: str = "jsonschema"
    message_encoding: str = "json"
    metadata: tuple[tuple[str, str], ...] = field(default=())

    @property
    def name(self) -> str:
        """The channel's name in results: `force` for `/force`."""
        return self.topic.lstrip("/")


def _channel(topic: str, name: str, description: str, properties: dict[str, Any]) -> ChannelInfo:
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": name,
        "description": description,
        "type": "object",
        "properties": properties,
    }
    return ChannelInfo(topic, name, json.dumps(schema, separators=(",", ":")).encode())


FORCE = _channel(
    "/force",
    "tissuebench.ForceTorque",
    "One sample of the force/torque sensor in its own axes: N, N m, and raw counts (null if it has none).",
    {
        "rdt_sequence": _INTEGER,
        "ft_sequence": _INTEGER,
        "status": _INTEGER,
        "counts": {"type": ["array", "null"], "items": _INTEGER, "description": "Fx Fy Fz Tx Ty Tz"},
        "force": {**_AXES, "description": "N"},
        "torque": {**_AXES, "description": "N m"},
    },
)
DEPTH = _channel(
    "/depth",
    "tissuebench.Depth",
    "One position of the actuator, positive into the tissue.",
    {
        "depth": {**_NUMBER, "description": "m"},
        "counts": {"type": ["integer", "null"], "description": "the board's reading, 0 to 1023"},
        "target": {**_NUMBER, "description": "m, commanded"},
    },
)
CAMERA = _channel(
    "/camera",
    "foxglove.CompressedImage",
    "One picture as the camera encoded it.",
    {
        "timestamp": _TIME,
        "frame_id": {"type": "string"},
        "frame": {**_INTEGER, "description": "number of the frame"},
        "format": {"type": "string"},
        "data": {"type": "string", "contentEncoding": "base64"},
    },
)
EVENTS = _channel(
    "/events",
    "foxglove.Log",
    "Something that happened during the trial.",
    {
        "timestamp": _TIME,
        "level": {**_INTEGER, "description": "2 info, 3 warning, 4 error"},
        "message": {"type": "string"},
        "name": {"type": "string", "description": "the kind of event"},
        "file": {"type": "string"},
        "line": _INTEGER,
    },
)
CHANNELS: dict[int, ChannelInfo] = {1: FORCE, 2: DEPTH, 3: CAMERA, 4: EVENTS}
"""The channels of every trial this bench writes, by their number in the file."""


def nanoseconds(time: float) -> int:
    """Turn seconds into whole nanoseconds, to the nearest."""
    return round(time * NANOSECONDS)


def _number(value: float | None) -> str:
    return repr(float(value)) if value is not None and math.isfinite(value) else "null"


def _axes(vector: Vector) -> str:
    x, y, z = vector
    return f'{{"x":{_number(x)},"y":{_number(y)},"z":{_number(z)}}}'


def _timestamp(time: float) -> str:
    seconds, rest = divmod(nanoseconds(time), NANOSECONDS)
    return f'{{"sec":{seconds},"nsec":{rest}}}'


def _encode_force(record: ForceRecord) -> bytes:
    counts = "null" if record.counts is None else f"[{','.join(map(str, record.counts))}]"
    return (
        f'{{"rdt_sequence":{record.rdt_sequence},"ft_sequence":{record.ft_sequence},'
        f'"status":{record.status},"counts":{counts},'
        f'"force":{_axes(record.force)},"torque":{_axes(record.torque)}}}'
    ).encode()


def _encode_depth(record: PositionRecord) -> bytes:
    counts = "null" if record.counts is None else record.counts
    return f'{{"depth":{_number(record.depth)},"counts":{counts},"target":{_number(record.target)}}}'.encode()


def _encode_frame(record: FrameRecord) -> bytes:
    head = (
        f'{{"timestamp":{_timestamp(record.time)},"frame_id":"camera","frame":{record.frame},'
        f'"format":{json.dumps(record.format)},"data":"'
    )
    return head.encode() + base64.b64encode(record.data) + b'"}'


def _encode_event(record: EventRecord) -> bytes:
    head = f'{{"timestamp":{_timestamp(record.time)},"level":{_LEVELS[record.level]},'
    body = f'"message":{json.dumps(record.message)},"name":{json.dumps(record.kind)},"file":"","line":0}}'
    return (head + body).encode()


_ENCODERS: dict[type, tuple[int, Callable[[Any], bytes]]] = {
    ForceRecord: (1, _encode_force),
    PositionRecord: (2, _encode_depth),
    FrameRecord: (3, _encode_frame),
    EventRecord: (4, _encode_event),
}


def encode(record: Record) -> tuple[int, bytes]:
    """Give the channel number (of `CHANNELS`) and the message bytes of a record."""
    channel, encoder = _ENCODERS[type(record)]
    return channel, encoder(record)


def decode_force(time: float, data: bytes) -> ForceRecord:
    """Read a message of `/force`.

    Raises
    ------
    ValueError, KeyError, TypeError
        The message is none.
    """
    message = _message(data)
    counts = message["counts"]
    return ForceRecord(
        time,
        _whole(message["rdt_sequence"]),
        _whole(message["ft_sequence"]),
        _whole(message["status"]),
        _vector(message["force"]),
        _vector(message["torque"]),
        None if counts is None else _six(counts),
    )


def _vector(axes: Mapping[str, object]) -> Vector:
    return _float(axes["x"]), _float(axes["y"]), _float(axes["z"])


def _float(value: object) -> float:
    """A number, NaN for null; raises ValueError for anything else."""
    if value is None:
        return math.nan
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{value!r:.40} is no number")
    try:
        return float(value)
    except OverflowError:
        raise ValueError("a number beyond what a double holds") from None


def _whole(value: object) -> int:
    """A whole number of at most 63 bits; raises ValueError for anything else."""
    if isinstance(value, bool) or not isinstance(value, int) or abs(value) >= 1 << 63:
        raise ValueError(f"{value!r:.40} is no such whole number")
    return value


def _six(values: Any) -> tuple[int, int, int, int, int, int]:
    fx, fy, fz, tx, ty, tz = map(_whole, values)
    return fx, fy, fz, tx, ty, tz


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{value!r:.40} is no text")
    return value


def _message(data: bytes) -> dict[str, Any]:
    """The object of a message; raises ValueError where it is none."""
    try:
        message = json.loads(data.decode())
    except RecursionError:
        raise ValueError("nested too deeply") from None
    if not isinstance(message, dict):
        raise ValueError("no object")
    return message


def decode_depth(time: float, data: bytes) -> PositionRecord:
    """Read a message of `/depth`; raises as `decode_force`."""
    message = _message(data)
    counts, target = message["counts"], message["target"]
    return PositionRecord(
        time,
        _float(message["depth"]),
        None if counts is None else _whole(counts),
        None if target is None else _float(target),
    )


def decode_frame(time: float, data: bytes) -> FrameRecord:
    """Read a message of `/camera`; raises as `decode_force`."""
    message = _message(data)
    picture = base64.b64decode(_text(message["data"]))
    return FrameRecord(time, _whole(message["frame"]), picture, _text(message["format"]))


def decode_event(time: float, data: bytes) -> EventRecord:
    """Read a message of `/events`; raises as `decode_force`."""
    message = _message(data)
    return EventRecord(time, _text(message["name"]), _text(message["message"]), _LEVEL_NAMES[_whole(message["level"])])
