"""How long a frame takes: median and p99 of many, one after the other, by the clock and by the processor.

The clock counts what else the machine does; the processor's time leaves out the waiting.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

WARM_UP, LEAST, MOST, BUDGET = 5, 20, 3000, 1.5
"""Frames; seconds a row."""


@dataclass(frozen=True)
class Times:
    """Microseconds of so many frames."""

    median: float
    p99: float
    cpu_median: float
    cpu_p99: float
    frames: int


def microseconds(call: Callable[[float], object]) -> Times:
    """Time a call with a force, again and again."""
    for step in range(WARM_UP):
        call(0.01 * step)
    times: list[tuple[int, int]] = []
    end = time.perf_counter() + BUDGET
    while len(times) < LEAST or (len(times) < MOST and time.perf_counter() < end):
        force = 0.05 + 0.0001 * (len(times) % 500)
        start, cpu = time.perf_counter_ns(), time.thread_time_ns()
        call(force)
        cpu_end = time.thread_time_ns()
        times.append((time.perf_counter_ns() - start, cpu_end - cpu))
    table = np.array(times) / 1e3
    (median, cpu_median), (p99, cpu_p99) = np.median(table, axis=0), np.quantile(table, 0.99, axis=0)
    return Times(float(median), float(p99), float(cpu_median), float(cpu_p99), len(times))
