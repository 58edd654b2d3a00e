"""The table of a blind run: shares with Clopper-Pearson bounds against the bars, and who was taken for whom."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import beta

from benchmark.blind.judging import CONFIDENT, Judged

Interval = tuple[float, float]


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
    """

    measure: str
    value: float
    ci95: Interval
    n: int
    bar: str
    passed: bool | None


def table(cases: Sequence[Judged]) -> tuple[BlindRow, ...]:
    """The rows of all measures for which there are cases."""
    effects = [case for case in cases if case.kind == "effect"]
    nulls = [case for case in cases if case.kind == "null"]
    pairs = [case for case in cases if case.kind == "pair"]
    outside = [case for case in cases if case.kind == "outside"]
    placed = [case for case in cases if case.place_found is not None and case.kind in ("effect", "pair")]
    named = [case for case in effects if case.reported]
    gaps = [case for case in effects if case.gap_closed is not None]
    rows = [
        _share("right name first", effects, lambda case: case.said.split("+")[0] == case.truth, ">= 0.9"),
        _share(
            "right name first, up to look-alikes",
            effects,
            lambda case: case.truth in case.first_set.split("+"),
            ">= 0.95",
        ),
        _share(
            "truth inside the reported set", effects, lambda case: case.truth in case.reported.split("+"), ">= 0.95"
        ),
        _average("mean size of the reported set", named, lambda case: len(case.reported.split("+")), "<= 1.6"),
        _share("effects named on nulls", nulls, lambda case: bool(case.said), "<= 0.02"),
        _share("nulls without a discrepancy", nulls, lambda case: case.verdict == "no_discrepancy", ""),
        _share("outside: wrong confident name", outside, lambda case: case.verdict in CONFIDENT, "<= 0.1"),
        _share("outside: flagged", outside, lambda case: case.verdict == "outside_catalogue", ">= 0.8"),
        _share("pairs: both named", pairs, _both_named, ">= 0.7"),
        _share("place contains the true one", placed, lambda case: bool(case.place_found), ">= 0.95"),
        _average("F1 over cells", placed, lambda case: case.place_f1 or 0.0, ">= 0.85"),
        _median("gap closed on a held-out condition", gaps, lambda case: case.gap_closed or 0.0, ">= 0.8"),
        _median("seconds a case", cases, lambda case: case.seconds, ""),
        _share("cases with an error", cases, lambda case: case.verdict == "error", ""),
    ]
    return tuple(row for row in rows if row.n)


def confusion(cases: Sequence[Judged]) -> dict[str, Counter[str]]:
    """For each truth ("none" for nulls) how often which name came first (or the verdict, where none did)."""
    out: dict[str, Counter[str]] = {}
    for case in cases:
        first = case.said.split("+")[0] or f"({case.verdict})"
        out.setdefault(case.truth or "none", Counter())[first] += 1
    return out


def verdicts(cases: Sequence[Judged]) -> Counter[str]:
    """How often each verdict was given."""
    return Counter(case.verdict for case in cases)


def clopper_pearson(hits: int, n: int, level: float = 0.95) -> Interval:
    """Exact interval of a share."""
    tail = 0.5 * (1.0 - level)
    low = float(beta.ppf(tail, hits, n - hits + 1)) if hits else 0.0
    high = float(beta.ppf(1.0 - tail, hits + 1, n - hits)) if hits < n else 1.0
    return low, high


def _share(measure: str, cases: Sequence[Judged], right: Callable[[Judged], bool], bar: str) -> BlindRow:
    hits, n = sum(right(case) for case in cases), len(cases)
    if n == 0:
        return BlindRow(measure, 0.0, (0.0, 1.0), 0, bar, None)
    return BlindRow(measure, hits / n, clopper_pearson(hits, n), n, bar, _passed(hits / n, bar))


def _average(measure: str, cases: Sequence[Judged], value: Callable[[Judged], float], bar: str) -> BlindRow:
    return _statistic(measure, [value(case) for case in cases], bar, middle=False)


def _median(measure: str, cases: Sequence[Judged], value: Callable[[Judged], float], bar: str) -> BlindRow:
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


def _both_named(case: Judged) -> bool:
    return set(case.truth.split("+")) <= set(case.said.split("+"))
