"""One record's bytes to the objects of the mcap library, with everything checked that can be checked.

Each record is handed to the library alone, so that a damaged inner length cannot reach into the next one.
"""

from __future__ import annotations

import io
import struct
import zlib
from dataclasses import dataclass
from typing import Any, NamedTuple

from bench_hw.trial_file.framing import (
    CHANNEL,
    CHUNK,
    CHUNK_DATA_AT,
    CHUNK_LENGTH_AT,
    FOOTER,
    MAGIC,
    MESSAGE,
    SCHEMA,
    Buffer,
    Frame,
    frame_at,
)

_LARGEST_CHUNK = 256 * 1024 * 1024
_FOOTER_BYTES = 29
_FOOTER_CRC_AT = 25
_RECORD_HEAD = struct.Struct("<BQ")
_MESSAGE_HEAD = struct.Struct("<HIQQ")


class UnreadableError(ValueError):
    """A record that is not what it says it is."""


def parse_record(buffer: Buffer, frame: Frame) -> Any:
    """Give the library's object for a record.

    Raises
    ------
    UnreadableError
        The bytes are no such record.
    """
    from mcap.stream_reader import StreamReader

    body = buffer[frame.start + 9 : frame.end]
    if frame.opcode == CHUNK:
        length = (frame.end - frame.start - CHUNK_DATA_AT).to_bytes(8, "little")
        body = body[: CHUNK_LENGTH_AT - 9] + length + body[CHUNK_DATA_AT - 9 :]
    record = bytes([frame.opcode]) + len(body).to_bytes(8, "little") + body
    try:
        reader = StreamReader(io.BytesIO(record), skip_magic=True, emit_chunks=True, record_size_limit=None)
        return next(iter(reader.records))
    except Exception as error:  # arbitrary bytes end the library's parser in many ways
        raise UnreadableError(f"not readable ({type(error).__name__})") from error


class RawMessage(NamedTuple):
    """A message as it stands in the file.

    Parameters
    ----------
    channel : int
        Number of its channel.
    sequence : int
        Its number in its channel, modulo 2^32.
    time, publish_time : int
        ns on the capture's monotonic clock.
    data : bytes
        What was recorded.
    """

    channel: int
    sequence: int
    time: int
    publish_time: int
    data: bytes


class ChunkContents(NamedTuple):
    """What a chunk holds: definitions by number (the library's objects), and messages in their order."""

    schemas: dict[int, Any]
    channels: dict[int, Any]
    messages: list[RawMessage]


def read_chunk(buffer: Buffer, frame: Frame) -> ChunkContents:
    """Give the contents of a chunk, proved by its CRC.

    Raises
    ------
    UnreadableError
        The chunk is damaged.
    """
    import zstandard

    chunk = parse_record(buffer, frame)
    try:
        size = zstandard.get_frame_parameters(chunk.data).content_size
        if size != chunk.uncompressed_size or size > _LARGEST_CHUNK:
            raise UnreadableError("its size is damaged")
        data = zstandard.ZstdDecompressor().decompress(chunk.data, allow_extra_data=False)
    except (zstandard.ZstdError, MemoryError) as error:
        raise UnreadableError("it cannot be decompressed") from error
    if chunk.uncompressed_crc != zlib.crc32(data):
        raise UnreadableError("its contents do not fit its checksum")
    return _contents(data)


def _contents(data: bytes) -> ChunkContents:
    """Split the records of a chunk; messages, which are many, without the library's detour."""
    contents = ChunkContents({}, {}, [])
    at = 0
    while at < len(data):
        if at + _RECORD_HEAD.size > len(data):
            raise UnreadableError("a record goes on over its end")
        opcode, length = _RECORD_HEAD.unpack_from(data, at)
        start, at = at, at + _RECORD_HEAD.size + length
        if at > len(data) or (opcode == MESSAGE and length < _MESSAGE_HEAD.size):
            raise UnreadableError("a record goes on over its end")
        if opcode == MESSAGE:
            body = start + _RECORD_HEAD.size
            channel, sequence, time, published = _MESSAGE_HEAD.unpack_from(data, body)
            message = RawMessage(channel, sequence, time, published, data[body + _MESSAGE_HEAD.size : at])
            contents.messages.append(message)
        elif opcode in (SCHEMA, CHANNEL):
            record = parse_record(data, Frame(start, at, opcode))
            (contents.schemas if opcode == SCHEMA else contents.channels)[record.id] = record
    return contents


@dataclass(frozen=True, eq=False)
class Summary:
    """The summary at the end of a file that was closed, proved by its CRC.

    Parameters
    ----------
    start : int
        Its first byte.
    records : tuple
        The library's objects.
    rows : dict of int to int
        Number of messages by channel number, as the writer counted them.
    """

    start: int
    records: tuple[Any, ...]
    rows: dict[int, int]


def read_summary(buffer: Buffer) -> Summary | None:
    """Read the summary from the end of the file; None where there is none or it is damaged."""
    footer_start = len(buffer) - len(MAGIC) - _FOOTER_BYTES
    if footer_start < 0 or buffer[len(buffer) - len(MAGIC) :] != MAGIC:
        return None
    frame = frame_at(buffer, footer_start)
    if frame is None or (frame.opcode, frame.end) != (FOOTER, footer_start + _FOOTER_BYTES):
        return None
    footer = parse_record(buffer, frame)
    start = footer.summary_start
    if not 0 < start <= footer_start:
        return None
    if zlib.crc32(buffer[start : footer_start + _FOOTER_CRC_AT]) != footer.summary_crc:
        return None
    return _summary_records(buffer, start, footer_start)


def _summary_records(buffer: Buffer, start: int, end: int) -> Summary | None:
    from mcap.records import Statistics

    records = []
    at = start
    while at < end:
        frame = frame_at(buffer, at)
        if frame is None or frame.opcode == CHUNK:
            return None
        records.append(parse_record(buffer, frame))
        at = frame.end
    rows = [record.channel_message_counts for record in records if isinstance(record, Statistics)]
    return Summary(start, tuple(records), {k: v for k, v in rows[0].items() if v}) if rows else None
