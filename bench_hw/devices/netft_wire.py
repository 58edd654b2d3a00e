"""The bytes of the ATI Net F/T's RDT protocol (UDP): requests and records, nothing else.

A request is 8 bytes `>HHI` (0x1234, command, sample count; count 0 streams without end). A record is 36
bytes `>IIIiiiiii` (rdt_sequence, ft_sequence, status, Fx, Fy, Fz, Tx, Ty, Tz in counts); a datagram in
buffered mode holds several. Source: ATI's Net F/T manual, chapter on RDT.
"""

from __future__ import annotations

import struct
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

HEADER = 0x1234
REQUEST = struct.Struct(">HHI")
RECORD = np.dtype([("rdt_sequence", ">u4"), ("ft_sequence", ">u4"), ("status", ">u4"), ("counts", ">i4", (6,))])
RDT_PORT = 49152
HTTP_PORT = 80
INTERNAL_RATE = 7000
"""Samples per second inside the box, Hz; the output is every n-th of them."""


LARGEST_BUFFER = 40
"""Most records in a datagram of buffered mode."""


class Command(IntEnum):
    """What a client may ask of the box."""

    STOP = 0x0000
    START_REALTIME = 0x0002
    START_BUFFERED = 0x0003
    RESET_LATCH = 0x0041
    BIAS = 0x0042


class Status(IntEnum):
    """Status words and bits that matter to a bench."""

    HEALTHY = 0x00000000
    SATURATED = 0x00020000
    CPU_OR_RAM = 0x40000000
    ERROR = 0x80000000
    LATCH = 0x00010000
    LATCH_ONLY = 0x80010000
    """The condition latch alone: something crossed a threshold once; a warning, no fault."""


def request(command: Command, count: int = 0) -> bytes:
    """Give the 8 bytes of a request.

    Raises
    ------
    ValueError
        `count` does not fit into 32 bits.
    """
    if not 0 <= count < 2**32:
        raise ValueError(f"sample count = {count}: allowed are 0 (endless) to 2^32 - 1")
    return REQUEST.pack(HEADER, command, count)


def parse_request(datagram: bytes) -> tuple[Command, int] | None:
    """Read a request; None if the bytes are none."""
    if len(datagram) != REQUEST.size:
        return None
    header, command, count = REQUEST.unpack(datagram)
    if header != HEADER or command not in set(Command):
        return None
    return Command(command), count


def parse_records(datagram: bytes) -> NDArray[np.void] | None:
    """Read the n records of one datagram, (n,) of `RECORD`; None if its length is no multiple of 36."""
    if not datagram or len(datagram) % RECORD.itemsize:
        return None
    return np.frombuffer(datagram, RECORD)


def rate_of(requested: int) -> int:
    """Give the rate (Hz) the box runs at when asked for `requested`: 7000 // (7000 // requested).

    Raises
    ------
    ValueError
        Outside 1 to 7000 Hz.
    """
    if not 1 <= requested <= INTERNAL_RATE:
        raise ValueError(f"rate = {requested} Hz: allowed are 1 to {INTERNAL_RATE} Hz")
    return INTERNAL_RATE // (INTERNAL_RATE // requested)


def divider_of(rate: int) -> int:
    """Give how many internal samples pass between two records at `rate` Hz."""
    return INTERNAL_RATE // rate
