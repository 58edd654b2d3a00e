"""What a trial has shown, from its log."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

UNCHANGED = "unchanged"

Row = Mapping[str, Any]


def summary(rows: Sequence[Row]) -> list[str]:
    """Lines of words: alarms of unchanged copies, faults caught, scatter of each time, length of a check."""
    lines = [_counts(name, [row for row in rows if row["copy"] == name]) for name in _names(rows)]
    unchanged = [row for row in rows if row["copy"] == UNCHANGED and row["document"]]
    lines += _scatter(unchanged)
    if rows:
        seconds = [row["seconds"] for row in rows]
        lines.append(f"a check took {statistics.median(seconds):.0f} s (median), at most {max(seconds):.0f} s")
    return lines


def caught(row: Row) -> bool:
    """Whether a check went red, and for the copy's own quantity where it has one."""
    if row["code"] != 1:
        return False
    failed = [
        each["quantity"] for part in ("timing", "accuracy") for each in row["document"][part] if not each["passed"]
    ]
    times = [each["quantity"] for each in row["document"]["timing"]]
    return row["copy"] not in times or row["copy"] in failed


def _names(rows: Iterable[Row]) -> list[str]:
    return list(dict.fromkeys(row["copy"] for row in rows))


def _counts(name: str, rows: Sequence[Row]) -> str:
    other = sum(row["code"] not in (0, 1) for row in rows)
    tail = f", {other} ended with another exit code" if other else ""
    if name == UNCHANGED:
        return f"{name}: {sum(row['code'] == 1 for row in rows)} false alarms in {len(rows)} checks{tail}"
    return f"{name}: caught in {sum(map(caught, rows))} of {len(rows)} checks{tail}"


def _scatter(rows: Sequence[Row]) -> list[str]:
    """How far unchanged copies look from the baseline and from each other, in per cent, and how near to their limit."""
    if len(rows) < 2:
        return []
    lines = []
    for index, first in enumerate(rows[0]["document"]["timing"]):
        times = [row["document"]["timing"][index] for row in rows]
        logs = [math.log(each["now_ratio"] / each["baseline_ratio"]) for each in times]
        limit = math.log(first["allowed"] / first["baseline_ratio"])
        mean, deviation, largest = (100 * each for each in (statistics.mean(logs), statistics.stdev(logs), max(logs)))
        apart = 100 * (max(logs) - min(logs))
        lines.append(
            f"{first['quantity']}, unchanged: mean {mean:+.1f} %, standard deviation {deviation:.1f} %, largest "
            f"{largest:+.1f} % (allowed {100 * math.expm1(limit):.0f} %), no two further apart than {apart:.1f} %"
        )
    return lines
