"""Statistics of interleaved timings: pure functions of numbers.

The unit is the measured process. Blocks inside one share its memory layout and its minute of the machine, so they are
autocorrelated and say nothing of the next process; they are condensed to one ratio, and scatter is taken between
processes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

BLOCK_CUT = 0.1
"""Of a process's blocks, the slowest and the fastest tenth are left out: turns of the machine, not of the product."""
PROCESS_CUT = 0.2
RESAMPLES = 2000


@dataclass(frozen=True)
class Change:
    """How much slower now than the baseline, as the logarithm of a factor.

    Attributes
    ----------
    estimate
        Difference of the trimmed means over processes.
    low, high
        95 % bootstrap interval over processes. With few of them it is too narrow (four cover about 85 %), so no
        decision rests on it alone.
    noise
        Standard error of the estimate from the scatter between processes; NaN with a single process.
    """

    estimate: float
    low: float
    high: float
    noise: float


def trimmed_mean(values: ArrayLike, cut: float) -> Array:
    """Mean over the first axis without the smallest and the largest `cut` of the values, each rounded down."""
    ordered = np.sort(np.asarray(values, dtype=np.float64), axis=0)
    away = int(cut * len(ordered))
    return np.asarray(ordered[away : len(ordered) - away].mean(axis=0))


def log_ratio(seconds: ArrayLike, references: ArrayLike) -> float:
    """Condense a process to one number: log of the time over the geometric mean of its references.

    Parameters
    ----------
    seconds
        (b,) time of a workload in each block.
    references
        (r, b) times of the references in the same blocks.

    Returns
    -------
    float
        Trimmed mean over the blocks of the logarithm. A slowdown of few calls among many is lost where it takes less
        than the trimmed tenth of the blocks.
    """
    paired = np.log(np.asarray(seconds)) - np.log(np.asarray(references)).mean(axis=0)
    return float(trimmed_mean(paired, BLOCK_CUT))


def change(now: ArrayLike, base: ArrayLike, *, paired: bool, seed: int) -> Change:
    """Compare processes.

    Parameters
    ----------
    now, base
        (p,) and (q,) log ratios of processes; at least one each.
    paired
        Whether process k of both ran in the same minute; then p = q.
    seed
        Of the bootstrap.
    """
    first, second = np.asarray(now, dtype=np.float64), np.asarray(base, dtype=np.float64)
    generator = np.random.default_rng(seed)
    if paired:
        first, second = first - second, np.zeros(1)
    draws = _resampled(first, generator) - _resampled(second, generator)
    low, high = np.quantile(draws, [0.025, 0.975])
    estimate = trimmed_mean(first, PROCESS_CUT) - trimmed_mean(second, PROCESS_CUT)
    return Change(float(estimate), float(low), float(high), _noise(first, second, paired=paired))


def false_alarm(limit: float, noise: float) -> float:
    """Chance that an unchanged product looks slower than `limit` (logarithm), for a normal error `noise`."""
    return _beyond(limit / noise)


def power(slowdown: float, limit: float, noise: float) -> float:
    """Chance that a product slower by `slowdown` (logarithm) looks slower than `limit`, for a normal error."""
    return _beyond((limit - slowdown) / noise)


def caught(limit: float, noise: float, share: float = 0.95) -> float:
    """The smallest slowdown (logarithm) that is caught in `share` of the checks, for a normal error."""
    from scipy.special import ndtri

    return limit + float(ndtri(share)) * noise


def _beyond(z: float) -> float:
    return 0.5 * math.erfc(z / math.sqrt(2.0))


def _resampled(values: Array, generator: np.random.Generator) -> Array:
    """(RESAMPLES,) trimmed means of bootstrap samples."""
    index = generator.integers(0, values.size, size=(values.size, RESAMPLES))
    return trimmed_mean(values[index], PROCESS_CUT)


def _noise(first: Array, second: Array, *, paired: bool) -> float:
    if first.size < 2 or (second.size < 2 and not paired):
        return math.nan
    parts: Sequence[Array] = (first,) if paired else (first, second)
    return math.sqrt(sum(float(part.var(ddof=1)) / part.size for part in parts))
