"""Where the records of an MCAP file begin and end, also in a file that is cut or has flipped bytes.

A record is an opcode, a length and contents. A damaged length would lead astray, so a chunk, which holds all
that was measured, is also recognised by its own inside: the name of its compression stands at a fixed
place, followed by the length of its data. What a chunk holds is then proved by its CRC, not here.
"""

from __future__ import annotations

import mmap
from dataclasses import dataclass

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


@dataclass(frozen=True)
class Frame:
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


def frame_at(buffer: Buffer, start: int) -> Frame | None:
    """Give the record that begins at a byte, or None where there is none that fits into the file."""
    head = buffer[start : start + _RECORD_HEAD]
    if len(head) < _RECORD_HEAD:
        return None
    opcode, end = head[0], _end_by_head(buffer, start)
    chunk_end = _chunk_end(buffer, start)
    if chunk_end is not None:
        sound = opcode == CHUNK and end == chunk_end == _end_by_inside(buffer, start)
        return Frame(start, chunk_end, CHUNK, sound)
    known = 0 < opcode <= _LAST_OPCODE and end <= len(buffer)
    return Frame(start, end, opcode) if known else None


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
