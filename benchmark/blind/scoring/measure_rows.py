"""A measure over cases: a share, mean or median with its 95 % interval, and whether it reaches its bar."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, TypeVar

import numpy as np
from scipy.stats import beta

Interval = tuple[float, float]
Case = TypeVar("Case")


@dataclass(frozen=True)
class BlindRow:
    """A measure: its value with a 95 % interval over `n` cases, and its bar.

    Attributes
    ----------
    measure : str
    value : float
    ci95 : (low, high)
    n : int
    bar : str
        As in ">= 0.9"; "" where there is none.
    passed : bool or None
        None without a bar.
    is_share : bool
        Whether it is a share of cases, not a mean or median.
    """

    measure: str
    value: float
    ci95: Interval
    n: int
    bar: str
    passed: bool | None
    is_share: bool = False

    def to_dict(self) -> dict[str, Any]:
        """Its columns in files."""
        return {name: value for name, value in asdict(self).items() if name != "is_share"}


def clopper_pearson(hits: int, n: int, level: float = 0.95) -> Interval:
    """Exact interval of a share."""
    tail = 0.5 * (1.0 - level)
    low = float(beta.ppf(tail, hits, n - hits + 1)) if hits else 0.0
    high = float(beta.ppf(1.0 - tail, hits + 1, n - hits)) if hits < n else 1.0
    return low, high


def share(measure: str, cases: Sequence[Case], right: Callable[[Case], bool], bar: str) -> BlindRow:
    """The share of cases that are right, with its exact interval."""
    hits, n = sum(right(case) for case in cases), len(cases)
    if n == 0:
        return BlindRow(measure, 0.0, (0.0, 1.0), 0, bar, None)
    return BlindRow(measure, hits / n, clopper_pearson(hits, n), n, bar, _passed(hits / n, bar), True)


def average(measure: str, cases: Sequence[Case], value: Callable[[Case], float], bar: str) -> BlindRow:
    """The mean of a value over cases."""
    return _statistic(measure, [value(case) for case in cases], bar, middle=False)


def median(measure: str, cases: Sequence[Case], value: Callable[[Case], float], bar: str) -> BlindRow:
    """The median of a value over cases."""
    return _statistic(measure, [value(case) for case in cases], bar, middle=True)


def _statistic(measure: str, values: Sequence[float], bar: str, *, middle: bool) -> BlindRow:
    """A mean or median with an interval by 2000 resamples of the cases."""
    if not values:
        return BlindRow(measure, 0.0, (0.0, 0.0), 0, bar, None)
    of = np.median if middle else np.mean
    data = np.array(values, dtype=np.float64)
    drawn = np.random.default_rng(0).integers(data.size, size=(2000, data.size))
    low, high = np.quantile(of(data[drawn], axis=1), [0.025, 0.975])
    value = float(of(data))
    return BlindRow(measure, value, (float(low), float(high)), data.size, bar, _passed(value, bar))


def _passed(value: float, bar: str) -> bool | None:
    if not bar:
        return None
    sign, limit = bar.split()
    return value >= float(limit) if sign == ">=" else value <= float(limit)
