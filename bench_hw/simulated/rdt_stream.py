"""The records one client of the simulated box gets: which are due, in which order and datagrams, with which faults.

Faults come by position in the stream (counted from 1) or by chance. Pure but for its random generator: no sockets, no
clock.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bench_hw.devices.rdt import INTERNAL_RATE, RECORD
from bench_hw.errors import InputError

MODULUS = 2**32
Measure = Callable[[NDArray[np.float64]], tuple[NDArray[np.int32], NDArray[np.uint32]]]
"""Instants (n,) of the clock, s, to counts (n, 6) and status words (n,)."""


@dataclass(frozen=True, slots=True)
class StreamFaults:
    """Faults of a stream of records.

    Parameters
    ----------
    loss : float
        Chance that a record is lost, 0 to 1.
    drop, duplicate, reorder : frozenset of int
        Positions that are lost, sent twice, or sent after the record that follows.
    duplication, reordering : float
        The same by chance, 0 to 1.
    """

    loss: float = 0.0
    drop: frozenset[int] = field(default_factory=frozenset)
    duplicate: frozenset[int] = field(default_factory=frozenset)
    reorder: frozenset[int] = field(default_factory=frozenset)
    duplication: float = 0.0
    reordering: float = 0.0

    def __post_init__(self) -> None:
        for name in ("loss", "duplication", "reordering"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise InputError(f"{name} = {getattr(self, name)}: allowed are 0 to 1")


def parse_positions(text: str) -> frozenset[int]:
    """Read positions like `200-202,500`.

    Raises
    ------
    InputError
        Not numbers and ranges separated by commas, below 1, or a range that runs backwards.
    """
    return frozenset(position for part in text.split(",") if part.strip() for position in _range(part.strip()))


def _range(part: str) -> Iterable[int]:
    first, dash, last = part.partition("-")
    ends = (first, last if dash else first)
    if not all(end.strip().isdecimal() for end in ends) or not 1 <= int(ends[0]) <= int(ends[1]) <= 10_000_000:
        raise InputError(f"positions {part!r}: allowed are numbers from 1 and ranges like 200-202")
    return range(int(ends[0]), int(ends[1]) + 1)


@dataclass(frozen=True, slots=True)
class StreamSettings:
    """How a stream was asked for.

    Parameters
    ----------
    divider : int
        Internal samples per record.
    records_per_datagram : int
        1 in realtime mode.
    count : int
        Records wanted; 0 is endless.
    first_sequence : int
        rdt_sequence of the first record (1 in a real box; another one to come near the wrap).
    """

    divider: int
    records_per_datagram: int = 1
    count: int = 0
    first_sequence: int = 1


class RdtStream:
    """One stream from its request on.

    Parameters
    ----------
    settings : StreamSettings
        How it was asked for.
    began : float
        Reading of the clock at the request, s; the first record is one period later.
    measure : Measure
        What the sensor reads.
    faults : StreamFaults
        Which faults to show.
    rng : numpy.random.Generator
        Source of chance.
    """

    def __init__(
        self,
        settings: StreamSettings,
        began: float,
        measure: Measure,
        faults: StreamFaults,
        rng: np.random.Generator,
    ) -> None:
        self._settings, self._began, self._measure = settings, began, measure
        self._faults, self._rng = faults, rng
        self._period = settings.divider / INTERNAL_RATE
        self._position = 0
        self._held: bytes | None = None
        self._waiting: list[bytes] = []
        self._shift = 0
        self._frozen_at: int | None = None
        self.sent = 0
        self.dropped = 0

    @property
    def finished(self) -> bool:
        """Whether the wanted number of records has been produced."""
        return 0 < self._settings.count <= self._position

    def pause(self, duration: float) -> None:
        """Produce nothing for `duration` seconds; the numbering goes on unbroken."""
        self._began += duration

    def restart(self) -> None:
        """Restart both counters, as after a loss of power."""
        self._shift = -self._position

    def freeze(self, frozen: bool) -> None:
        """Let the sample number (ft_sequence) stand still while records go on, or move again."""
        self._frozen_at = self._position + self._shift if frozen else None

    def due(self, now: float) -> list[bytes]:
        """Give the datagrams that are due at the reading `now`, oldest first."""
        last = int((now - self._began) / self._period + 1e-6)
        if self._settings.count:
            last = min(last, self._settings.count)
        if last <= self._position:
            return []
        positions = np.arange(self._position + 1, last + 1)
        self._position = last
        data = self._records(positions).tobytes()
        size = RECORD.itemsize
        records = [data[k : k + size] for k in range(0, len(data), size)]
        return self._datagrams(self._with_faults(positions, records))

    def _records(self, positions: NDArray[np.int64]) -> NDArray[np.void]:
        counts, status = self._measure(np.asarray(self._began + positions * self._period))
        numbers = positions + self._shift
        samples = numbers if self._frozen_at is None else np.full_like(numbers, self._frozen_at)
        records = np.zeros(len(positions), RECORD)
        records["rdt_sequence"] = (self._settings.first_sequence - 1 + numbers) % MODULUS
        records["ft_sequence"] = (samples * self._settings.divider) % MODULUS
        records["status"] = status
        records["counts"] = counts
        return records

    def _with_faults(self, positions: NDArray[np.int64], records: list[bytes]) -> list[bytes]:
        faults = self._faults
        if faults == StreamFaults():
            self.sent += len(records)
            return records
        lost, doubled, late = _chances(faults) > self._rng.random((3, len(records)))
        out: list[bytes] = []
        for row, (position, record) in enumerate(zip(positions.tolist(), records, strict=True)):
            if lost[row] or position in faults.drop:
                self.dropped += 1
            elif self._held is None and (late[row] or position in faults.reorder):
                self._held = record
            else:
                out += [record] * (2 if doubled[row] or position in faults.duplicate else 1)
                out += [] if self._held is None else [self._held]
                self._held = None
        self.sent += len(out)
        return out

    def _datagrams(self, records: list[bytes]) -> list[bytes]:
        size = self._settings.records_per_datagram
        if size == 1:
            return records
        waiting = self._waiting + records
        whole = len(waiting) if self.finished else len(waiting) - len(waiting) % size
        self._waiting = waiting[whole:]
        return [b"".join(waiting[k : min(k + size, whole)]) for k in range(0, whole, size)]


def _chances(faults: StreamFaults) -> NDArray[np.float64]:
    return np.array([[faults.loss], [faults.duplication], [faults.reordering]])
