"""What a slice of work costs, on a machine that others use too.

Wall time counts the turns of other programs; CPU time misses a slice that sleeps or waits for a disk. Linux tells how
long a thread stood in the queue for a core, so that

    cost = max(CPU time of the process, wall time - time in the queue)

counts computing and waiting, and no one else's turn. Where the system does not tell, the cost is the CPU time.
"""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import NamedTuple

QUEUE = Path("/proc/thread-self/schedstat")
_LINE_BYTES = 128


class Reading(NamedTuple):
    """Nanoseconds so far: wall clock, CPU of the process, and this thread's time in the queue for a core."""

    wall: int
    cpu: int
    queued: int


class Clock:
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

    def read(self) -> Reading:
        """The times now."""
        queued = self._queued() if self.sees_waiting else None
        return Reading(time.perf_counter_ns(), time.process_time_ns(), queued or 0)

    def seconds(self, before: Reading, after: Reading) -> float:
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

    def __enter__(self) -> Clock:
        return self

    def __exit__(self, *_: object) -> None:
        if self._file is not None:
            os.close(self._file)
            self._file = None
