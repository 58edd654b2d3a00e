"""The RDT stream of an ATI Net F/T box: bytes, status words, counters and time stamps. No sockets here.

A request is 8 bytes `>HHI` (0x1234, command, sample count; count 0 streams without end). A record is 36 bytes
`>IIIiiiiii` (rdt_sequence, ft_sequence, status, Fx, Fy, Fz, Tx, Ty, Tz in counts); a datagram in buffered mode holds
several. Source: ATI's Net F/T manual, chapter on RDT.

Counters: with delta = (now - previous) mod 2^32, 0 is a duplicate, 1 is good, below 2^31 is a gap of delta - 1,
anything else is an earlier record. Of those, one that fills a gap was late (reordered, no longer lost), one already
seen is a duplicate, and one further back than `WINDOW` means that the counter restarted.

Stamps: what is measured is the moment of reading. Samples that waited in the socket or in one datagram were taken
earlier, by their distance in the sequence times the period, or less where they would run into the call before.
"""

from __future__ import annotations

import struct
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from bench_hw.devices.protocols import StreamHealth

HEADER = 0x1234
REQUEST = struct.Struct(">HHI")
RECORD = np.dtype([("rdt_sequence", ">u4"), ("ft_sequence", ">u4"), ("status", ">u4"), ("counts", ">i4", (6,))])
RDT_PORT = 49152
HTTP_PORT = 80
INTERNAL_RATE = 7000
"""Samples per second inside the box, Hz; the output is every n-th of them."""


LARGEST_BUFFER = 40
"""Most records in a datagram of buffered mode."""
_BITS = {
    30: "CPU or RAM error",
    29: "digital board error",
    28: "analog board error",
    27: "serial link error",
    26: "program memory error",
    25: "halted by a configuration error",
    24: "settings not valid",
    23: "settings do not fit the calibration",
    22: "network failure",
    20: "RDT failure",
    17: "transducer saturated",
    16: "condition latched",
    1: "analog board watchdog",
    0: "excessive gauge current",
}
MODULUS = 2**32
HALF = MODULUS // 2
WINDOW = 256
"""How late (in records) one may be and still be called late; further back is a restart."""
TICK = 1e-6
"""Least distance between two stamps, s."""


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


HARMLESS = (Status.HEALTHY, Status.LATCH, Status.LATCH_ONLY)
"""Every status word that is no fault; the error bit by itself is one, whose cause the box does not name."""


def is_fault(status: int) -> bool:
    """Tell whether a status word says more than "a threshold was crossed once"."""
    return status not in HARMLESS


def is_saturated(status: int) -> bool:
    """Tell whether the transducer was beyond its range, so that the record's force is too small."""
    return bool(status & Status.SATURATED)


def describe(status: int) -> str:
    """Say in words what a status word means."""
    named = [text for bit, text in _BITS.items() if status >> bit & 1]
    other = status & ~Status.ERROR & ~sum(1 << bit for bit in _BITS)
    named += [f"other bits {other:#x}"] if other else []
    return ", ".join(named) or ("an error whose cause is not named" if status & Status.ERROR else "healthy")


class SequenceTracker:
    """Follows `rdt_sequence` and `ft_sequence` of one stream."""

    def __init__(self) -> None:
        self._last: int | None = None
        self._base = 0
        self._last_ft = 0
        self._missing: dict[int, None] = {}
        self._counts = dict.fromkeys(StreamHealth.__dataclass_fields__, 0)

    @property
    def health(self) -> StreamHealth:
        """The counts so far."""
        return StreamHealth(**self._counts)

    def accept(self, rdt: NDArray[np.uint32], ft: NDArray[np.uint32]) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
        """Take the counters of records in order of arrival.

        Parameters
        ----------
        rdt, ft : ndarray (n,) of uint32
            The counters of the n records.

        Returns
        -------
        tuple of ndarray (n,) of bool and ndarray (n,) of int64
            Which records are new (the others are duplicates), and their unwrapped rdt_sequence.
        """
        if self._plain(rdt, ft):
            return self._accept_plain(rdt, ft)
        keep = np.ones(len(rdt), bool)
        unwrapped = np.empty(len(rdt), np.int64)
        for row, (sequence, sample) in enumerate(zip(rdt.tolist(), ft.tolist(), strict=True)):
            keep[row], unwrapped[row] = self._take(sequence, sample)
        return keep, unwrapped

    def _plain(self, rdt: NDArray[np.uint32], ft: NDArray[np.uint32]) -> bool:
        if self._last is None or not len(rdt) or self._last + len(rdt) >= MODULUS:
            return False
        expected = np.arange(self._last + 1, self._last + 1 + len(rdt))
        steps = np.remainder(np.diff(ft.astype(np.int64), prepend=self._last_ft), MODULUS)
        return bool(np.all((steps > 0) & (steps < HALF))) and bool(np.array_equal(rdt, expected))

    def _accept_plain(
        self, rdt: NDArray[np.uint32], ft: NDArray[np.uint32]
    ) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
        self._last, self._last_ft = int(rdt[-1]), int(ft[-1])
        self._counts["received"] += len(rdt)
        return np.ones(len(rdt), bool), self._base + rdt.astype(np.int64)

    def _take(self, sequence: int, sample: int) -> tuple[bool, int]:
        if self._last is None:
            return self._accept_one(sequence, sample)
        delta = (sequence - self._last) % MODULUS
        if delta == 0:
            return self._duplicate(self._base + sequence)
        if delta < HALF:
            return self._forward(sequence, sample, gap=delta - 1)
        return self._backward(sequence, sample, MODULUS - delta)

    def _accept_one(self, sequence: int, sample: int) -> tuple[bool, int]:
        self._counts["received"] += 1
        self._last, self._last_ft = sequence, sample
        return True, self._base + sequence

    def _duplicate(self, unwrapped: int) -> tuple[bool, int]:
        self._counts["duplicates"] += 1
        return False, unwrapped

    def _forward(self, sequence: int, sample: int, gap: int) -> tuple[bool, int]:
        if self._last is not None and sequence < self._last:
            self._base += MODULUS
        step = (sample - self._last_ft) % MODULUS
        self._counts["stalls"] += step == 0
        self._counts["restarts"] += step >= HALF
        self._note_gap(self._base + sequence, gap)
        return self._accept_one(sequence, sample)

    def _note_gap(self, at: int, gap: int) -> None:
        self._counts["lost"] += gap
        self._missing.update(dict.fromkeys(range(max(at - gap, at - WINDOW), at)))
        while len(self._missing) > 4 * WINDOW:
            del self._missing[next(iter(self._missing))]

    def _backward(self, sequence: int, sample: int, distance: int) -> tuple[bool, int]:
        unwrapped = self._base + (self._last or 0) - distance
        if distance > WINDOW or self._restarted(sequence, sample):
            return self._restart(sequence, sample)
        if unwrapped not in self._missing:
            return self._duplicate(unwrapped)
        del self._missing[unwrapped]
        self._counts["lost"] -= 1
        self._counts["reordered"] += 1
        self._counts["received"] += 1
        return True, unwrapped

    def _restarted(self, sequence: int, sample: int) -> bool:
        """Tell a counter that begins at 1 again soon after it began: its sample is newer than the last."""
        return sequence <= 1 and 0 < (sample - self._last_ft) % MODULUS < HALF

    def _restart(self, sequence: int, sample: int) -> tuple[bool, int]:
        self._counts["restarts"] += 1
        self._base += (self._last or 0) + 1 - sequence
        self._missing.clear()
        return self._accept_one(sequence, sample)


def back_dated(now: float, previous: float, sequence: NDArray[np.int64], period: float) -> NDArray[np.float64]:
    """Stamp samples read at `now`.

    Parameters
    ----------
    now : float
        Moment of reading, s.
    previous : float
        Stamp of the last sample of the call before (-inf if there is none), s.
    sequence : ndarray (n,)
        Unwrapped sequence numbers in order of arrival; the highest was taken at `now`.
    period : float
        Time between two samples, s.

    Returns
    -------
    ndarray (n,)
        Sampling instants, s: at least `TICK` apart and after `previous`.
    """
    if not len(sequence):
        return np.zeros(0)
    newest = sequence.max()
    spread = min(period, (now - previous) / (newest - sequence.min() + 1))
    instants = now - (newest - sequence) * spread
    ramp = TICK * np.arange(1, len(sequence) + 1)
    floored = np.maximum(instants, previous + ramp)
    stamps: NDArray[np.float64] = np.maximum.accumulate(floored - ramp) + ramp
    return stamps
