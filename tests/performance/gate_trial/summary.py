"""What a trial has shown, from its log."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

UNCHANGED = "unchanged"
TOGETHER = " + "
"""Between the names of the faults that one copy has."""

Row = Mapping[str, Any]


def summary(rows: Sequence[Row]) -> list[str]:
    """Lines of words: alarms of unchanged copies, faults caught, scatter of each time, cost of a check."""
    lines = [line for name in _names(rows) for line in _counts(name, [row for row in rows if row["copy"] == name])]
    for name in _names(rows):
        lines += _seen(name, [row for row in rows if row["copy"] == name and row["document"]])
    return lines + _cost(rows)


def caught(row: Row, fault: str) -> bool:
    """Whether a check went red, and for the faulty quantity itself where it is a time."""
    if row["code"] != 1:
        return False
    times = {each["quantity"]: each["passed"] for each in row["document"]["timing"]}
    return not times.get(fault, False)


def _names(rows: Iterable[Row]) -> list[str]:
    return list(dict.fromkeys(row["copy"] for row in rows))


def _counts(name: str, rows: Sequence[Row]) -> list[str]:
    other = sum(row["code"] not in (0, 1) for row in rows)
    tail = f", {other} ended with another exit code" if other else ""
    if name == UNCHANGED:
        return [f"{name}: {sum(row['code'] == 1 for row in rows)} false alarms in {len(rows)} checks{tail}"]
    return [
        f"{fault}: caught in {sum(caught(row, fault) for row in rows)} of {len(rows)} checks{tail}"
        for fault in name.split(TOGETHER)
    ]


def _seen(name: str, rows: Sequence[Row]) -> list[str]:
    """How far the times of a copy look from the baseline and from each other, in per cent, and what is allowed."""
    if len(rows) < 2:
        return []
    lines = []
    for index, first in enumerate(rows[0]["document"]["timing"]):
        times = [row["document"]["timing"][index] for row in rows]
        logs = [math.log(each["now_ratio"] / each["baseline_ratio"]) for each in times]
        allowed = 100 * (first["allowed"] / first["baseline_ratio"] - 1)
        mean, least, largest = (100 * math.expm1(each) for each in (statistics.mean(logs), min(logs), max(logs)))
        lines.append(
            f"{first['quantity']} in {name}: mean {mean:+.1f} %, standard deviation {100 * statistics.stdev(logs):.1f} "
            f"%, {least:+.1f} % to {largest:+.1f} % (allowed {allowed:.0f} %)"
        )
    return lines


def _cost(rows: Sequence[Row]) -> list[str]:
    """What a check took, and how much else the machine did."""
    if not rows:
        return []
    spread = []
    for key in ("seconds", "cpu_seconds", "load"):
        values = [row[key] for row in rows]
        spread.append((min(values), statistics.median(values), max(values)))
    wall, cpu, load = spread
    return [
        f"a check took {wall[1]:.0f} s (median; {wall[0]:.0f} to {wall[2]:.0f} s) and {cpu[1]:.0f} s of CPU "
        f"({cpu[0]:.0f} to {cpu[2]:.0f} s) at a load average of {load[1]:.1f} ({load[0]:.1f} to {load[2]:.1f})"
    ]
