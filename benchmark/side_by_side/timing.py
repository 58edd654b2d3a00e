"""Repeated timings and the speed-up with its interval."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.side_by_side.messages import Seconds


@dataclass(frozen=True)
class Speedup:
    """FEM wall time over wave wall time of interleaved repeats: median and 95 % bootstrap interval."""

    median: float
    ci95: tuple[float, float]
    repeats: int


def median_seconds(repeats: Sequence[Seconds]) -> Seconds:
    """Median of each part over the repeats."""
    table = np.array([(r.setup, r.wall, r.cpu) for r in repeats])
    setup, wall, cpu = np.median(table, axis=0)
    return Seconds(float(setup), float(wall), float(cpu))


def speedup(slow: Sequence[Seconds], fast: Sequence[Seconds], *, seed: int, resamples: int = 2000) -> Speedup:
    """Ratio of wall times, repeat by repeat, so that a drifting machine cancels.

    The interval is the percentile bootstrap of the median over the pairs; with three pairs it spans them all.
    """
    ratios = np.array([s.wall / f.wall for s, f in zip(slow, fast, strict=True)])
    draws = np.random.default_rng(seed).integers(0, ratios.size, size=(resamples, ratios.size))
    low, high = np.quantile(np.median(ratios[draws], axis=1), [0.025, 0.975])
    return Speedup(float(np.median(ratios)), (float(low), float(high)), int(ratios.size))
