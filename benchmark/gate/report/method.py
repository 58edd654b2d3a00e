"""How the verdict came about, in the report's own words."""

from __future__ import annotations

import math

from benchmark.gate.statistics import false_alarm, power
from benchmark.gate.timing import TimingRow
from benchmark.gate.verdict import Verdict
from reports import Column, Paragraph, Section, Table

SLOWDOWN = 0.25
LEAST = 1e-6

HOW = (
    "A value passes where |now - baseline| is at most rtol |baseline| + atol. Time is measured in fresh processes with "
    "one thread; each runs all timed quantities and the reference work (NumPy and SciPy alone) in turn, in blocks of a "
    "tenth of a second. A quantity is divided, block by block, by the references of its own texture, so that a machine "
    "that slows down slows both; blocks are condensed to one ratio a process (mean of the logarithms without the "
    "highest and the lowest tenth), and processes to a trimmed mean. Waiting for a core is not counted, sleeping is. "
    "A quantity is called slower where it exceeds its baseline by more than the margin, after the most processes the "
    "gate file allows; a check ends sooner only where everything is far below its margin."
)


def method_section(verdict: Verdict) -> Section:
    """Return the section on method, with the chances of error at the scatter seen in this check."""
    if not verdict.timing:
        return Section("Method", (Paragraph(HOW),))
    columns = (
        "quantity",
        Column("margin", "%", 3),
        Column("standard error", "%", 2),
        "chance of a false alarm",
        f"chance to miss {100 * SLOWDOWN:g} %",
    )
    table = Table(
        "Chances of error for a normal error of the size of the scatter between the processes of this check; a state "
        "of the machine that lasts longer than a check is not in it",
        columns,
        [_chances(row) for row in verdict.timing],
    )
    return Section("Method", (Paragraph(HOW), table))


def _chances(row: TimingRow) -> tuple[str, float, float, str, str]:
    limit, noise = math.log(row.allowed / row.baseline), row.noise
    chances = ("", "")
    if noise > 0.0:
        missed = 1.0 - power(math.log1p(SLOWDOWN), limit, noise)
        chances = (_chance(false_alarm(limit, noise)), _chance(missed))
    return (row.quantity, 100.0 * math.expm1(limit), 100.0 * noise, *chances)


def _chance(value: float) -> str:
    """A chance in words; below one in a million no normal distribution is to be believed."""
    return f"below {LEAST:g}" if value < LEAST else f"{value:.2g}"
