"""The way through a file from record to record, around whatever is damaged."""

from __future__ import annotations

import zlib
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from bench_hw.trial_file.mcap_records import (
    CHUNK,
    DATA_END,
    MAGIC,
    METADATA,
    Buffer,
    RecordExtent,
    UnreadableError,
    frame_at,
    next_frame,
    parse_record,
    read_chunk,
)
from bench_hw.trial_file.metadata import RECOVERY, TRIAL, is_sealed


@dataclass(frozen=True)
class Damage:
    """Bytes that are not what they should be, from `start` up to `end`."""

    start: int
    end: int
    reason: str

    def __str__(self) -> str:
        return f"bytes {self.start} to {self.end}: {self.reason}"


@dataclass
class Walk:
    """What was met on the way.

    Parameters
    ----------
    chunks : list of RecordExtent
        The chunks that are whole.
    damages : list of Damage
        What is not, up to the end of the data.
    rows : Counter
        Messages by channel number.
    schemas, channels : dict
        The library's objects by their numbers, from chunks that are whole.
    metadata : dict
        Entries by name, of the records of this bench whose checksum fits.
    data_end : int or None
        Where the data end, None where that was not met.
    """

    chunks: list[RecordExtent] = field(default_factory=list)
    damages: list[Damage] = field(default_factory=list)
    rows: Counter[int] = field(default_factory=Counter)
    schemas: dict[int, Any] = field(default_factory=dict)
    channels: dict[int, Any] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    data_end: int | None = None


def walk_through(buffer: Buffer, end: int) -> Walk:
    """Go from record to record up to a byte.

    Parameters
    ----------
    buffer : bytes-like
        The file.
    end : int
        Where the summary begins, or the file's length where there is none.
    """
    walk = Walk()
    at = len(MAGIC)
    if buffer[:at] != MAGIC:
        at = _skip(walk, buffer, 0, "the file does not begin as a trial file")
    while at < end:
        frame = frame_at(buffer, at)
        if frame is not None:
            at = _take(walk, buffer, frame)
        elif walk.data_end is None:
            at = _skip(walk, buffer, at, "no record begins here")
        else:
            at = next_frame(buffer, at + 1)
    return walk


def _skip(walk: Walk, buffer: Buffer, start: int, reason: str, end: int | None = None) -> int:
    """Note a damage and go on at the next chunk, or at the end the damaged record states if one begins there."""
    at = next_frame(buffer, start + 1)
    if end is not None and end < at and frame_at(buffer, end) is not None:
        at = end
    cut = "the last record is cut off or unreadable"
    walk.damages.append(Damage(start, at, cut if at == len(buffer) else reason))
    return at


def _take(walk: Walk, buffer: Buffer, frame: RecordExtent) -> int:
    try:
        _use(walk, buffer, frame)
    except UnreadableError as error:
        if walk.data_end is not None:
            return frame.end
        reason = f"damaged {'chunk' if frame.opcode == CHUNK else 'record'}: {error}"
        return _skip(walk, buffer, frame.start, reason, frame.end)
    return frame.end


def _use(walk: Walk, buffer: Buffer, frame: RecordExtent) -> None:
    if frame.opcode == CHUNK:
        _use_chunk(walk, buffer, frame)
        return
    if frame.opcode not in (METADATA, DATA_END):
        return  # an index or the like: nothing in it is needed here
    record = parse_record(buffer, frame)
    if frame.opcode == METADATA and record.name in (TRIAL, RECOVERY):
        if not is_sealed(record.metadata):
            raise UnreadableError("metadata that do not fit their checksum")
        walk.metadata[record.name] = record.metadata
    elif frame.opcode == DATA_END:
        walk.data_end = frame.end
        if not walk.damages and record.data_section_crc not in (0, _crc(buffer, frame.start)):
            reason = "bytes outside the chunks are damaged, the data do not fit their checksum"
            walk.damages.append(Damage(frame.start, frame.end, reason))


def _crc(buffer: Buffer, end: int) -> int:
    with memoryview(buffer) as view, view[:end] as part:
        return zlib.crc32(part)


def _use_chunk(walk: Walk, buffer: Buffer, frame: RecordExtent) -> None:
    contents = read_chunk(buffer, frame)
    walk.schemas |= contents.schemas
    walk.channels |= contents.channels
    walk.rows.update(message.channel for message in contents.messages)
    walk.chunks.append(frame)
    walk.data_end = None
    if not frame.sound:
        reason = "the head of a chunk is damaged, its contents are whole"
        walk.damages.append(Damage(frame.start, frame.start + 9, reason))
