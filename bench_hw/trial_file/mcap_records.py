"""The records of an MCAP file: where they begin and end, and what they hold, also in a file that is cut or damaged.

A record is an opcode, a length and contents. A damaged length would misplace the next record, so a chunk, which holds
all that was measured, is also recognised by its own inside: the name of its compression stands at a fixed place,
followed by the length of its data. Contents count only where their CRC fits. Each record is handed to the mcap library
alone, so that a damaged inner length cannot reach into the next one. The way from record to record is in `walk`.
"""

from __future__ import annotations

import io
import mmap
import struct
import zlib
from dataclasses import dataclass
from typing import Any, NamedTuple

MAGIC = b"\x89MCAP0\r\n"
FOOTER = 0x02
SCHEMA = 0x03
CHANNEL = 0x04
MESSAGE = 0x05
CHUNK = 0x06
METADATA = 0x0C
DATA_END = 0x0F
_LAST_OPCODE = 0x0F
_RECORD_HEAD = 9
_COMPRESSION_AT = 37
CHUNK_LENGTH_AT = 45
CHUNK_DATA_AT = 53
_COMPRESSION = b"\x04\x00\x00\x00zstd"
_DATA_END_HEAD = b"\x0f\x04\x00\x00\x00\x00\x00\x00\x00"

Buffer = bytes | mmap.mmap
_LARGEST_CHUNK = 256 * 1024 * 1024
_FOOTER_BYTES = 29
_FOOTER_CRC_AT = 25
_HEAD = struct.Struct("<BQ")
_MESSAGE_HEAD = struct.Struct("<HIQQ")


@dataclass(frozen=True)
class RecordExtent:
    """The extent of one record.

    Parameters
    ----------
    start, end : int
        First byte, and the byte after the last.
    opcode : int
        What it is; `CHUNK` for everything that is a chunk inside.
    sound : bool
        Whether opcode and length say the same as the inside.
    """

    start: int
    end: int
    opcode: int
    sound: bool = True


def frame_at(buffer: Buffer, start: int) -> RecordExtent | None:
    """Give the record that begins at a byte, or None where there is none that fits into the file."""
    head = buffer[start : start + _RECORD_HEAD]
    if len(head) < _RECORD_HEAD:
        return None
    opcode, end = head[0], _end_by_head(buffer, start)
    chunk_end = _chunk_end(buffer, start)
    if chunk_end is not None:
        sound = opcode == CHUNK and end == chunk_end == _end_by_inside(buffer, start)
        return RecordExtent(start, chunk_end, CHUNK, sound)
    known = 0 < opcode <= _LAST_OPCODE and end <= len(buffer)
    return RecordExtent(start, end, opcode) if known else None


def _end_by_head(buffer: Buffer, start: int) -> int:
    return start + _RECORD_HEAD + int.from_bytes(buffer[start + 1 : start + _RECORD_HEAD], "little")


def _end_by_inside(buffer: Buffer, start: int) -> int:
    return start + CHUNK_DATA_AT + int.from_bytes(buffer[start + CHUNK_LENGTH_AT : start + CHUNK_DATA_AT], "little")


def _chunk_end(buffer: Buffer, start: int) -> int | None:
    """Give the end of a chunk; where its two lengths differ, the one behind which a record begins."""
    if buffer[start + _COMPRESSION_AT : start + CHUNK_LENGTH_AT] != _COMPRESSION:
        return None
    inside, head = _end_by_inside(buffer, start), _end_by_head(buffer, start)
    ends = [end for end in (inside, head) if start + CHUNK_DATA_AT < end <= len(buffer)]
    if inside == head or len(ends) < 2:
        return ends[0] if ends else None
    return next((end for end in ends if _begins(buffer, end)), ends[0])


def _begins(buffer: Buffer, start: int) -> bool:
    head = buffer[start : start + 1]
    if not head:
        return True
    return 0 < head[0] <= _LAST_OPCODE and _end_by_head(buffer, start) <= len(buffer)


def next_frame(buffer: Buffer, start: int) -> int:
    """Find the next place that begins a chunk or the end of the data; the file's length if there is none."""
    places = (_next_chunk(buffer, start), _next_data_end(buffer, start))
    return min((place for place in places if place is not None), default=len(buffer))


def _next_chunk(buffer: Buffer, start: int) -> int | None:
    at = buffer.find(_COMPRESSION, start + _COMPRESSION_AT)
    while at >= 0:
        if _chunk_end(buffer, at - _COMPRESSION_AT) is not None:
            return at - _COMPRESSION_AT
        at = buffer.find(_COMPRESSION, at + 1)
    return None


def _next_data_end(buffer: Buffer, start: int) -> int | None:
    at = buffer.find(_DATA_END_HEAD, start)
    while at >= 0:
        behind = frame_at(buffer, at + len(_DATA_END_HEAD) + 4)
        if behind is not None:
            return at
        at = buffer.find(_DATA_END_HEAD, at + 1)
    return None


class UnreadableError(ValueError):
    """A record that is not what it says it is."""


def parse_record(buffer: Buffer, frame: RecordExtent) -> Any:
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


def read_chunk(buffer: Buffer, frame: RecordExtent) -> ChunkContents:
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
        if at + _HEAD.size > len(data):
            raise UnreadableError("a record runs past its end")
        opcode, length = _HEAD.unpack_from(data, at)
        start, at = at, at + _HEAD.size + length
        if at > len(data) or (opcode == MESSAGE and length < _MESSAGE_HEAD.size):
            raise UnreadableError("a record runs past its end")
        if opcode == MESSAGE:
            body = start + _HEAD.size
            channel, sequence, time, published = _MESSAGE_HEAD.unpack_from(data, body)
            message = RawMessage(channel, sequence, time, published, data[body + _MESSAGE_HEAD.size : at])
            contents.messages.append(message)
        elif opcode in (SCHEMA, CHANNEL):
            record = parse_record(data, RecordExtent(start, at, opcode))
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
