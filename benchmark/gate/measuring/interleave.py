"""Workloads and references in turn, block by block, each slice timed by itself."""

from __future__ import annotations

import gc
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from benchmark.gate.measuring.clock import Clock
from benchmark.gate.measuring.references import Work

WARM_UP = 2


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


def measure_block(slices: Mapping[str, Slice], clock: Clock) -> dict[str, float]:
    """Run each slice once, in order, and return the seconds of one call of each."""
    return {name: _measure(each, clock) / each.calls for name, each in slices.items()}


def _measure(part: Slice, clock: Clock) -> float:
    work: Any = part.work
    before = clock.read()
    for _ in range(part.calls):
        work()
    return clock.seconds(before, clock.read())
