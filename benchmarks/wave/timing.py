"""How long a frame takes: median and p99 of many, one after the other, on whatever else the machine does."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

WARM_UP, LEAST, MOST, BUDGET = 5, 20, 3000, 1.5
"""Frames; seconds a row."""


def microseconds(call: Callable[[float], object]) -> tuple[float, float, int]:
    """Median and p99 of a call with a force, in microseconds, and how many calls."""
    for step in range(WARM_UP):
        call(0.01 * step)
    times, end = [], time.perf_counter() + BUDGET
    while len(times) < LEAST or (len(times) < MOST and time.perf_counter() < end):
        force = 0.05 + 0.0001 * (len(times) % 500)
        start = time.perf_counter_ns()
        call(force)
        times.append(time.perf_counter_ns() - start)
    return float(np.median(times)) / 1e3, float(np.quantile(times, 0.99)) / 1e3, len(times)
