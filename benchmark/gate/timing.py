"""The verdict on time: each timed quantity against the baseline's, or against another revision's."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from benchmark.gate.gate_file import Timed, Timing
from benchmark.gate.statistics import Change, caught, change

Ratios = Mapping[str, Sequence[float]]
"""Log ratios of the processes, by timed quantity."""

SURE = 2.0
"""Measuring ends before the most rounds only where every estimate is this many standard errors from its limit."""
USUAL_SCATTER, USUAL_ROUNDS = 0.03, 4
"""Scatter between processes (logarithm) on a shared machine: a few processes that agree by chance count as so many more
of this scatter."""
DECISIVE = 5
"""Rounds before anything is called slower, as long as the gate file allows as many: from five on, the mean of the
processes leaves the highest and the lowest out."""


@dataclass(frozen=True)
class TimingRow:
    """One timed quantity.

    Attributes
    ----------
    quantity
        Its name.
    baseline, now
        Time in units of its references: the geometric mean over the baseline's processes, and that times the change.
    allowed
        The largest `now` that passes.
    ci95
        Interval of `now`, the baseline's scatter included.
    caught
        The smallest slowdown, a fraction, that 19 of 20 checks catch at this scatter between processes; NaN where
        there is only one.
    noise
        Standard error of the slowdown (logarithm) from the scatter between processes; NaN where there is only one.
    passed
        Whether `now` is at most `allowed`.
    """

    quantity: str
    baseline: float
    now: float
    allowed: float
    ci95: tuple[float, float]
    caught: float
    noise: float
    passed: bool

    @property
    def slowdown(self) -> float:
        """How much slower than the baseline, a fraction; negative where it is faster."""
        return self.now / self.baseline - 1.0

    @property
    def wanted(self) -> float:
        """The slowdown, a fraction, that should be caught: the limit is half of it, on the logarithm."""
        return (self.allowed / self.baseline) ** 2 - 1.0

    @property
    def faster(self) -> bool:
        """Whether it is as much faster as what would have to be slower to fail, and its interval says so."""
        return self.now * self.allowed <= self.baseline**2 and self.ci95[1] < self.baseline

    def to_dict(self) -> dict[str, Any]:
        """The row for `check.json`."""
        return {
            "quantity": self.quantity,
            "baseline_ratio": self.baseline,
            "now_ratio": self.now,
            "ci95": list(self.ci95),
            "allowed": self.allowed,
            "passed": self.passed,
            "faster": self.faster,
            "slowdown_percent": 100.0 * self.slowdown,
            "caught_19_of_20_percent": 100.0 * self.caught,
        }


@dataclass(frozen=True)
class Judge:
    """How times are judged.

    Attributes
    ----------
    timed, timing
        Of the gate file.
    paired
        Whether process k of both sides ran in the same minute.
    same_machine
        Whether the baseline comes from this machine.
    seed
        Of the bootstrap.
    """

    timed: Sequence[Timed]
    timing: Timing
    paired: bool
    same_machine: bool
    seed: int

    def limit(self, timed: Timed) -> float:
        """The largest logarithm of a slowdown that passes."""
        usual = self.timing.margin_against if self.paired else self.timing.margin
        margin = usual if timed.margin is None else timed.margin
        if not self.same_machine:
            margin = max(margin, self.timing.other_machine_margin)
        return math.log1p(margin)

    def rows(self, now: Ratios, base: Ratios) -> tuple[TimingRow, ...]:
        """One row a timed quantity."""
        return tuple(self._row(each, now[each.name], base[each.name]) for each in self.timed)

    def clear(self, now: Ratios, base: Ratios) -> bool:
        """Whether every quantity is surely on one side of its limit, so that more rounds would change nothing."""
        rounds = min(len(now[each.name]) for each in self.timed)
        errors = [
            (found.estimate - self.limit(each)) / careful_noise(found.noise, rounds)
            for each in self.timed
            for found in (self._change(now[each.name], base[each.name]),)
        ]
        return all(error < -SURE or (error > SURE and rounds >= DECISIVE) for error in errors)

    def _change(self, now: Sequence[float], base: Sequence[float]) -> Change:
        return change(now, base, paired=self.paired, seed=self.seed)

    def _row(self, timed: Timed, now: Sequence[float], base: Sequence[float]) -> TimingRow:
        found, limit = self._change(now, base), self.limit(timed)
        level = math.exp(math.fsum(base) / len(base))
        return TimingRow(
            quantity=timed.name,
            baseline=level,
            now=level * math.exp(found.estimate),
            allowed=level * math.exp(limit),
            ci95=(level * math.exp(found.low), level * math.exp(found.high)),
            caught=math.expm1(caught(limit, found.noise)),
            noise=found.noise,
            passed=found.estimate <= limit,
        )


def careful_noise(noise: float, rounds: int) -> float:
    """The standard error of a change, from its processes and `USUAL_ROUNDS` more with the usual scatter.

    Parameters
    ----------
    noise
        Standard error from the scatter between the processes alone; NaN where there is only one.
    rounds
        How many they are.
    """
    own = 0.0 if math.isnan(noise) else (rounds - 1) * noise**2
    usual = USUAL_ROUNDS * USUAL_SCATTER**2 / rounds
    return math.sqrt((own + usual) / (rounds - 1 + USUAL_ROUNDS))
