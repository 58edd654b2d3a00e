"""The verdict of a check, and its words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from benchmark.gate.accuracy import AccuracyRow
from benchmark.gate.timing import TimingRow
from reports.formatting import counted

SCHEMA = 1


@dataclass(frozen=True)
class CheckVerdict:
    """What a check found.

    Attributes
    ----------
    gate
        Name of the gate file.
    accuracy, timing
        One row a quantity.
    accuracy_source, timing_source
        What "baseline" is in each, in words.
    rounds
        Measured processes of each side.
    against
        Full name of the other commit; None for a stored baseline.
    warnings
        What a reader must know.
    accepted_here
        Values for which no check can be red: the baseline was accepted at this revision, in place of one from which
        they differed.
    """

    gate: str
    accuracy: Sequence[AccuracyRow]
    timing: Sequence[TimingRow]
    accuracy_source: str
    timing_source: str
    rounds: int
    against: str | None
    warnings: Sequence[str]
    accepted_here: Sequence[str] = ()

    @property
    def passed(self) -> bool:
        """Whether nothing got worse."""
        return all(row.passed for row in self.accuracy) and all(row.passed for row in self.timing)

    @property
    def _values(self) -> list[AccuracyRow]:
        return [row for row in self.accuracy if row.at is None]

    @property
    def _curves(self) -> list[AccuracyRow]:
        return [row for row in self.accuracy if row.at is not None]

    @property
    def _kinds(self) -> list[tuple[list[AccuracyRow], str]]:
        """Rows of accuracy by what they are; curves where there are any."""
        return [(self._values, "value"), *([(self._curves, "curve")] if self._curves else [])]

    def failures(self) -> list[str]:
        """One line for each quantity that got worse: what, baseline, now, allowed."""
        values = [value_words(row) for row in self.accuracy if not row.passed]
        return values + [time_words(row) for row in self.timing if not row.passed]

    def improvements(self) -> list[str]:
        """One line for each time that got better by more than its margin; a new baseline would keep it."""
        return [time_words(row) for row in self.timing if row.faster]

    def summary(self) -> list[str]:
        """One line for the values and one for each time."""
        worst = max((row.share for row in self.accuracy), default=0.0)
        farthest = f"the farthest at {100 * worst:.3g} % of its allowance"
        curves = f" and {counted(len(self._curves), 'curve')} over the load" if self._curves else ""
        first = f"values: {len(self._values)}{curves} against {self.accuracy_source}, {farthest}"
        return [first, *(f"time: {time_words(row)}" for row in self.timing)]

    def headline(self) -> str:
        """The verdict in one sentence."""
        if self.passed:
            faster = len(self.improvements())
            better = f" {counted(faster, 'timing')} got faster." if faster else ""
            values = ", ".join(counted(len(rows), what) for rows, what in self._kinds)
            return f"Nothing got worse: {values} and {counted(len(self.timing), 'timing')} are within limits.{better}"
        bad = [f"{_bad(rows)} of {counted(len(rows), what)} changed" for rows, what in self._kinds]
        return f"{', '.join(bad)}, {_bad(self.timing)} of {counted(len(self.timing), 'timing')} slower."

    def to_dict(self) -> dict[str, Any]:
        """The content of `check.json`."""
        return {
            "schema": SCHEMA,
            "passed": self.passed,
            "gate": self.gate,
            "against": self.against,
            "accuracy_baseline": self.accuracy_source,
            "timing_baseline": self.timing_source,
            "accuracy": [row.to_dict() for row in self.accuracy],
            "timing": [row.to_dict() for row in self.timing],
            "rounds": self.rounds,
            "warnings": list(self.warnings),
            "accepted_here": list(self.accepted_here),
        }


def value_words(row: AccuracyRow) -> str:
    """One value against its baseline."""
    unit = f" {row.unit}" if row.unit else ""
    now = f"{row.now:.9g}{unit}" if row.now is not None else f"without a value ({row.reason})"
    base = f"{row.baseline:.9g}{unit}" if row.baseline is not None else "without a value"
    return f"{row.label}: baseline {base}, now {now}, allowed a difference of {row.allowed:.3g}{unit}"


def time_words(row: TimingRow) -> str:
    """One time against its baseline."""
    low, high = row.ci95
    return (
        f"{row.quantity}: baseline {row.baseline:.4g} x the reference workload, now {row.now:.4g} "
        f"(95 % interval {low:.4g} to {high:.4g}; {100 * row.slowdown:+.1f} %), allowed {row.allowed:.4g}"
    )


def _bad(rows: Sequence[AccuracyRow] | Sequence[TimingRow]) -> int:
    return sum(not row.passed for row in rows)
