"""Recordings in MCAP that other programs wrote: their topics as columns on one clock.

Messages are JSON, or with the libraries of the extra `instruments` those of ROS 2 (CDR) and protobuf. A number in a
message is a column, by the last parts of its place (`wrench.force.z` is `force.z`); lists of numbers beside a list of
names, as joints have, are named by those (`actuator position`). Units are those of a JSON schema's properties ("unit"),
of names, or where the schema is of ROS or Foxglove geometry those that its description states (N, m).

One topic's times are those of the table, the one with the force; what others hold is interpolated to them. What the
columns mean is for `column_choice`.
"""

from __future__ import annotations

import importlib
import json
import re
import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TableError
from bench_hw.instrument_files.blocks import Block
from bench_hw.instrument_files.vocabulary import label_and_unit, role_of
from bench_hw.storage.regular_file import DOCUMENT, open_regular
from bench_hw.trial_file.mcap_output import PROFILE
from bench_hw.trial_file.mcap_records import MAGIC

Array = NDArray[np.float64]
Decoder = Callable[[bytes], object]
NANOSECONDS: Final = 1e-9
LEAST_MESSAGES: Final = 2
GEOMETRY: Final = re.compile(r"(geometry_msgs|foxglove)\b.*")
STATED: Final = {"force": "N", "torque": "N m", "position": "m", "translation": "m"}
"""Units that these schemas' own descriptions state, by a part of a number's place."""
STAMPS: Final = ("stamp", "timestamp")
DECODERS: Final = {"cdr": "mcap_ros2.decoder", "protobuf": "mcap_protobuf.decoder"}
"""What decodes the messages of an encoding that is not JSON, by the schema in the file; of the extra `instruments`."""
LONGEST_LIST: Final = 64
"""A longer list is a picture or a scan, none of whose numbers is a column."""


@dataclass
class Topic:
    """The messages of one topic: clock and stamp in s, numbers by their place."""

    name: str
    units: Mapping[str, str]
    logged: list[float] = field(default_factory=list)
    stamped: list[float | None] = field(default_factory=list)
    rows: list[dict[str, float]] = field(default_factory=list)

    @property
    def places(self) -> list[str]:
        """Of the numbers that most messages have."""
        counts: dict[str, int] = {}
        for row in self.rows:
            for place in row:
                counts[place] = counts.get(place, 0) + 1
        return [place for place, count in counts.items() if 2 * count > len(self.rows)]

    def roles(self) -> set[str]:
        """The quantities that its columns plainly mean."""
        return {found[0] for place in self.places if (found := role_of(_label(place, self.units)[0])) is not None}


def is_foreign(path: Path) -> bool:
    """Whether a whole head says that another program wrote this recording; what has none is the bench's to recover."""
    try:
        with open_regular(path, DOCUMENT) as stream:
            head = stream.read(4096)
    except OSError:
        return False
    start = len(MAGIC) + 9
    if head[: len(MAGIC) + 1] != MAGIC + b"\x01" or len(head) < start + 4:
        return False
    (size,) = struct.unpack_from("<I", head, start)
    return head[start + 4 : start + 4 + size] != PROFILE.encode()


def topic_blocks(path: Path) -> list[Block]:
    """The one block of a recording.

    Raises
    ------
    TableError
        No topic has messages with numbers that can be read, or topics that belong together do not overlap in time.
    """
    if not is_foreign(path):
        problem = "this is a recording of bench_hw capture, or one without a whole head"
        allowed = "`benchmark run --trials` takes it as it is, `bench_hw export` writes its tables, `recover` mends it"
        raise TableError(path, problem, allowed)
    topics, others = _read(path)
    topics = [topic for topic in topics if len(topic.rows) >= LEAST_MESSAGES and topic.places]
    if not topics:
        listed = ", ".join(f"{name} ({encoding})" for name, encoding in sorted(others.items())) or "no messages"
        raise TableError(
            path,
            f"no topic of this recording has messages with numbers that can be read; it has {listed}",
            "a recording by `bench_hw capture`, messages in JSON, ROS 2's CDR or protobuf (pip install "
            "'tissuebench[instruments]'), or an export of the topics as csv with columns of time, force and depth, "
            'named by --set import.force="COLUMN:N" and --set import.depth="COLUMN:mm"',
        )
    forced = [topic for topic in topics if topic.roles() & {"force", "stress"}]
    base = max(forced or topics, key=lambda topic: len(topic.rows))
    beside = [topic for topic in topics if topic is not base and not (forced and topic in forced)]
    return [_joined(path, base, beside)]


def _read(path: Path) -> tuple[list[Topic], dict[str, str]]:
    """The topics whose messages can be read, and why the others cannot."""
    from mcap.reader import make_reader

    topics: dict[str, Topic] = {}
    others: dict[str, str] = {}
    decoders: dict[str, Decoder] = {}
    with open_regular(path, DOCUMENT) as stream:
        for schema, channel, message in make_reader(stream).iter_messages():
            name = channel.topic
            if name in others:
                continue
            try:
                if name not in decoders:
                    decoders[name] = _decoder(schema, channel.message_encoding)
                content = decoders[name](message.data)
            except UnreadableTopicError as error:
                if name in topics:
                    problem = f"message {len(topics[name].rows) + 1} of {name} cannot be read ({error})"
                    raise TableError(path, problem, "a whole recording, or an export of its topics as csv") from error
                others[name] = str(error)
                continue
            if name not in topics:
                topics[name] = Topic(name, _units(schema, content))
            topics[name].logged.append(NANOSECONDS * message.log_time)
            topics[name].stamped.append(_stamp(content))
            topics[name].rows.append(dict(_numbers(content)))
    return list(topics.values()), others


class UnreadableTopicError(ValueError):
    """The messages of a topic cannot be read; the text says why."""


def _decoder(schema: Any, encoding: str) -> Decoder:
    """What turns the bytes of a topic's messages into a table of names; `UnreadableTopicError` where nothing does."""
    if encoding.lower() == "json":
        return json.loads
    if encoding.lower() not in DECODERS:
        raise UnreadableTopicError(encoding or "no encoding named")
    try:
        factory = importlib.import_module(DECODERS[encoding.lower()]).DecoderFactory()
    except ImportError as error:
        raise UnreadableTopicError(f"{encoding}, whose library is not installed") from error
    decode = _guarded(factory.decoder_for, encoding, "its schema")(encoding.lower(), schema)
    if decode is None:
        raise UnreadableTopicError(f"{encoding} with no schema that its library reads")
    read = _guarded(decode, encoding, "a message")
    return lambda data: _plain(read(data))


def _guarded(call: Callable[..., Any], encoding: str, what: str) -> Callable[..., Any]:
    """A call of a library that says what it could not read: the libraries raise anything."""

    def guarded(*arguments: object) -> Any:
        try:
            return call(*arguments)
        except Exception as error:
            raise UnreadableTopicError(f"{encoding}, {type(error).__name__} in {what}") from error

    return guarded


def _plain(value: Any) -> object:
    """A decoded message as tables, lists and numbers; without bytes, and without messages that are not there."""
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, bytes | bytearray | memoryview):
        return None
    if hasattr(value, "DESCRIPTOR"):  # protobuf: a number that is nought does not stand in the bytes
        fields = [field for field in value.DESCRIPTOR.fields if not field.has_presence or value.HasField(field.name)]
        return {field.name: _plain(getattr(value, field.name)) for field in fields}
    if hasattr(value, "__slots__"):
        return {name: _plain(getattr(value, name)) for name in value.__slots__}
    if hasattr(value, "items"):
        return {str(key): _plain(inner) for key, inner in value.items()}
    return [_plain(each) for each in value] if len(value) <= LONGEST_LIST else None


def _numbers(value: object, place: str = "") -> Iterator[tuple[str, float]]:
    """Each number of a message with its place; times of stamps are not among them."""
    if isinstance(value, bool):
        return
    if isinstance(value, int | float):
        yield place, float(value)
    elif isinstance(value, dict):
        names = value.get("name")
        for key, inner in value.items():
            if key in STAMPS and isinstance(inner, dict):
                continue
            if isinstance(names, list) and isinstance(inner, list) and len(inner) == len(names) and inner is not names:
                for name, each in zip(names, inner, strict=True):
                    yield from _numbers(each, _within(place, f"{name} {key}"))
            else:
                yield from _numbers(inner, _within(place, key))
    elif isinstance(value, list) and len(value) <= LONGEST_LIST:
        for number, each in enumerate(value):
            yield from _numbers(each, f"{place}[{number}]")


def _within(place: str, key: str) -> str:
    return f"{place}.{key}" if place else str(key)


def _stamp(content: object) -> float | None:
    """The time (s) that a message carries, its own or its header's; None where it carries none."""
    if not isinstance(content, dict):
        return None
    owners = [owner for owner in (content, content.get("header")) if isinstance(owner, dict)]
    for stamp in (owner.get(key) for owner in owners for key in STAMPS):
        if isinstance(stamp, dict) and isinstance(seconds := stamp.get("sec", stamp.get("seconds")), int):
            fraction: Any = next((stamp[key] for key in ("nanosec", "nsec", "nanos") if key in stamp), 0)
            return float(seconds) + NANOSECONDS * float(fraction)
    return None


def _units(schema: Any, content: object) -> dict[str, str]:
    """Units of numbers by their places: what the schema's properties say, else what its kind states."""
    found: dict[str, str] = {}
    if schema is None:
        return found
    if schema.encoding == "jsonschema" and schema.data:
        found = dict(_said(json.loads(schema.data)))
    if GEOMETRY.match(schema.name):
        for place, _ in _numbers(content):
            stated = [STATED[part] for part in re.split(r"[.\[\] ]", place) if part in STATED]
            if stated:
                found.setdefault(place, stated[-1])
    return found


def _said(schema: object, place: str = "") -> Iterator[tuple[str, str]]:
    if isinstance(schema, dict):
        if isinstance(schema.get("unit"), str):
            yield place, schema["unit"]
        properties = schema.get("properties")
        for key, inner in properties.items() if isinstance(properties, dict) else ():
            yield from _said(inner, _within(place, key))


def _label(place: str, units: Mapping[str, str]) -> tuple[str, str]:
    """A column's name, the longest end of its place that plainly means a quantity, and its unit."""
    parts = place.split(".")
    for first in range(len(parts)):
        name, unit = label_and_unit(".".join(parts[first:]))
        if len(name) > 1 and role_of(name) is not None:  # the z of a torque is no height
            return name, units.get(place, unit)
    name, unit = label_and_unit(place)
    return name, units.get(place, unit)


def _joined(path: Path, base: Topic, beside: Sequence[Topic]) -> Block:
    """The columns of one topic with those of others at its times, as far as all of them go."""
    stamped = all(stamp is not None for topic in (base, *beside) for stamp in topic.stamped)
    clocks = {topic.name: _clock(topic, stamped=stamped) for topic in (base, *beside)}
    needed = [topic for topic in beside if topic.roles() and not topic.roles() <= base.roles()] or beside
    time = clocks[base.name]
    first = max([time[0], *(clocks[topic.name].min() for topic in needed)])
    last = min([time.max(), *(clocks[topic.name].max() for topic in needed)])
    kept = np.flatnonzero((time >= first) & (time <= last))
    if kept.size < LEAST_MESSAGES:
        listed = ", ".join(f"{name} {clock.min():.3f} to {clock.max():.3f} s" for name, clock in clocks.items())
        raise TableError(path, f"its topics do not overlap in time ({listed})", "topics that were recorded together")
    columns = [time[kept] - time[kept[0]]]
    names, units = ["time stamp" if stamped else "time"], ["s"]
    for topic in (base, *beside):
        for place in topic.places:
            values = np.array([row.get(place, np.nan) for row in topic.rows])
            columns.append(values[kept] if topic is base else _at(time[kept], clocks[topic.name], values))
            name, unit = _label(place, topic.units)
            names.append(name)
            units.append(unit)
    told = f"{base.name}, with {', '.join(topic.name for topic in beside)} at its times" if beside else base.name
    headers = tuple(f"{name} [{unit}]" if unit else name for name, unit in zip(names, units, strict=True))
    lines = kept + 1
    return Block(path, told, tuple(names), tuple(units), headers, tuple(columns), lines, spoken=told)


def _clock(topic: Topic, *, stamped: bool) -> Array:
    return np.array(topic.stamped if stamped else topic.logged, dtype=np.float64)


def _at(time: Array, clock: Array, values: Array) -> Array:
    """(n,) values at other times, linear between neighbours."""
    order = np.argsort(clock, kind="stable")
    whole = np.isfinite(values[order])
    return np.interp(time, clock[order][whole], values[order][whole])
