"""What a slice of work costs, on a machine that others use too.

Wall time counts the turns of other programs; CPU time misses a slice that sleeps or waits for a disk. Linux tells how
long a thread stood in the queue for a core, so that

    cost = max(CPU time of the process, wall time - time in the queue)

counts computing and waiting, and no one else's turn. Where the system does not tell, the cost is the CPU time.

Memory counts too. Left to itself, glibc gives an array of some hundred kilobytes back to the system and asks for it
again at each call, or does not, as the heap happens to lie. Then one process pays for page faults what another does
not, up to half of the time of an assembly, and no reference sees it. So what is freed stays with a measured process
(`KEPT_MEMORY`).
"""

from __future__ import annotations

import gc
import os
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from benchmark.gate.measuring.references import Work

QUEUE = Path("/proc/thread-self/schedstat")
_LINE_BYTES = 128
WARM_UP = 2


class ClockReading(NamedTuple):
    """Nanoseconds so far: wall clock, CPU of the process, and this thread's time in the queue for a core."""

    wall: int
    cpu: int
    queued: int


class CostClock:
    """Reads the three times; use as a context manager.

    Attributes
    ----------
    sees_waiting
        Whether the system tells the time in the queue, so that sleeping and waiting count as cost.
    """

    def __init__(self, queue: Path = QUEUE):
        self._file: int | None = None
        try:
            self._file = os.open(queue, os.O_RDONLY)
            self.sees_waiting = self._queued() is not None
        except OSError:
            self.sees_waiting = False

    def read(self) -> ClockReading:
        """The times now."""
        queued = self._queued() if self.sees_waiting else None
        return ClockReading(time.perf_counter_ns(), time.process_time_ns(), queued or 0)

    def seconds(self, before: ClockReading, after: ClockReading) -> float:
        """The cost between two readings in s."""
        cpu = after.cpu - before.cpu
        if not self.sees_waiting:
            return 1e-9 * cpu
        return 1e-9 * max(cpu, after.wall - before.wall - (after.queued - before.queued))

    def _queued(self) -> int | None:
        """The second number of `schedstat`; None where it is not there."""
        if self._file is None:
            return None
        fields = os.pread(self._file, _LINE_BYTES, 0).split()
        return int(fields[1]) if len(fields) > 1 and fields[1].isdigit() else None

    def __enter__(self) -> CostClock:
        return self

    def __exit__(self, *_: object) -> None:
        if self._file is not None:
            os.close(self._file)
            self._file = None


@dataclass(frozen=True)
class Slice:
    """One part of a block: work, and how often it runs in a row."""

    work: Work
    calls: int


def warm_up(slices: Mapping[str, Slice]) -> None:
    """Run everything before it counts, and take what is alive by then out of the garbage collector's way."""
    for _ in range(WARM_UP):
        for each in slices.values():
            each.work()
    gc.collect()
    gc.freeze()


def measure_block(slices: Mapping[str, Slice], clock: CostClock) -> dict[str, float]:
    """Run each slice once, in order, and return the seconds of one call of each."""
    return {name: _measure(each, clock) / each.calls for name, each in slices.items()}


def _measure(part: Slice, clock: CostClock) -> float:
    work: Any = part.work
    before = clock.read()
    for _ in range(part.calls):
        work()
    return clock.seconds(before, clock.read())


KEPT_MEMORY: Mapping[str, str] = MappingProxyType(
    {
        "MALLOC_MMAP_THRESHOLD_": str(2**30),
        "MALLOC_TRIM_THRESHOLD_": str(2**32),
        "MALLOC_TOP_PAD_": str(2**26),
    }
)
"""Environment of a measured process (bytes; mallopt(3)); other systems know none of these names."""
