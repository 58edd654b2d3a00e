"""Where a series of checks changed its level: the partition into constant pieces that costs least."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

PENALTY = 3.0
"""A step must lower the sum of squares, in units of the scatter, by this many times the logarithm of the length."""
FEW = 5.0
ODD = 5.0
"""Scatters from both neighbours beyond which a single check is odd."""
LEAST_SCATTER = 1e-6
"""Scatter of values that a computer repeats; anything beyond round-off is then a step."""


@dataclass(frozen=True)
class LevelStep:
    """One step: the first place of the new level, and the means before and after it."""

    place: int
    before: float
    after: float


def level_steps(series: ArrayLike, *, least: int, scatter: float | None = None) -> tuple[LevelStep, ...]:
    """Find the steps of a series by optimal partitioning (Jackson et al. 2005, doi:10.1109/LSP.2001.838216).

    Parameters
    ----------
    series
        (n,) values, oldest first, all finite.
    least
        The fewest values of a level: 1 where nothing scatters, 2 so that one odd check is no step.
    scatter
        Standard deviation within a level; from the differences of neighbours without it.

    Returns
    -------
    tuple
        In order; none for fewer than two values.
    """
    values = np.asarray(series, dtype=np.float64)
    if values.size < 2 * least:
        return ()
    unit = max(_scatter(values) if scatter is None else scatter, LEAST_SCATTER * (1.0 + float(np.abs(values).max())))
    whole = values if least == 1 else _without_odd(values, ODD * unit)
    places = _partition((whole - whole.mean()) / unit, least, PENALTY * math.log(values.size + 1.0))
    bounds = (0, *places, values.size)
    means = [float(whole[first:last].mean()) for first, last in pairwise(bounds)]
    return tuple(LevelStep(*each) for each in zip(places, means[:-1], means[1:], strict=True))


def _scatter(values: Array) -> float:
    """Scatter within levels: steps are few, so the median difference of neighbours does not see them.

    Of few differences the median is often far too small; `FEW` over their number makes up for it.
    """
    middle = float(np.median(np.abs(np.diff(values)))) / (0.6745 * math.sqrt(2.0))
    return middle * (1.0 + FEW / values.size)


def _without_odd(values: Array, far: float) -> Array:
    """Single values that are far from both neighbours on the same side become the nearer neighbour."""
    left, right = values[1:-1] - values[:-2], values[1:-1] - values[2:]
    odd = (left * right > 0.0) & (np.minimum(np.abs(left), np.abs(right)) > far)
    nearer = np.where(np.abs(left) < np.abs(right), values[:-2], values[2:])
    return np.concatenate((values[:1], np.where(odd, nearer, values[1:-1]), values[-1:]))


def _partition(values: Array, least: int, penalty: float) -> tuple[int, ...]:
    """First places of all levels but the first, of the partition with the least sum of squares and penalties."""
    count = values.size
    sums, squares = (np.concatenate(((0.0,), np.cumsum(part))) for part in (values, values**2))
    cost, last = np.full(count + 1, np.inf), np.zeros(count + 1, dtype=np.intp)
    cost[0] = -penalty
    for end in range(least, count + 1):
        starts = np.arange(end - least + 1)
        inside = squares[end] - squares[starts] - (sums[end] - sums[starts]) ** 2 / (end - starts)
        total = cost[starts] + inside + penalty
        last[end] = int(total.argmin())
        cost[end] = total[last[end]]
    places, end = [], int(last[count])
    while end > 0:
        places.append(end)
        end = int(last[end])
    return tuple(reversed(places))
