"""How far a sweep is and how long it may still take."""

from __future__ import annotations

import time
from collections.abc import Callable

from benchmark.sweep.point import FAILED, PointResult

Advance = Callable[[str, int, int, str], None]


class SweepProgress:
    """Counts finished points; the estimate rests on those that finished since the start of this command."""

    def __init__(self, total: int, done: int, advance: Advance, clock: Callable[[], float] = time.monotonic):
        self._total, self._before, self._advance, self._clock = total, done, advance, clock
        self._now = self._failed = 0
        self._started = clock()

    def add(self, row: PointResult) -> None:
        """Count a point and say so."""
        self._now += 1
        self._failed += row.status == FAILED
        done = self._before + self._now
        remarks = [_duration(self.remaining()) + " left" if done < self._total else ""]
        remarks.append(f"{self._failed} failed" if self._failed else "")
        self._advance("points", done, self._total, ", ".join(filter(None, remarks)))

    def remaining(self) -> float:
        """Seconds that the missing points may take."""
        left = self._total - self._before - self._now
        return (self._clock() - self._started) / max(self._now, 1) * left


def _duration(seconds: float) -> str:
    """A duration as a person says it."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
