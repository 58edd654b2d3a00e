"""The page of a check: verdict, what is compared with what, trend, and how the verdict came about."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from benchmark.gate.history.history_file import HistoryEntry
from benchmark.gate.history.trend import Trend, trend_figure, trends
from benchmark.gate.statistics import false_alarm, power
from benchmark.gate.timing import TimingRow
from benchmark.gate.verdict import CheckVerdict
from benchmark.gate.versions import Origin
from reports import Bullets, Column, Download, Fact, Notice, Page, Paragraph, Section, Table, Verdict

LEAST = 1e-6
HOW = (
    "A value passes where |now - baseline| is at most rtol |baseline| + atol. Time is measured in fresh processes with "
    "one thread; each runs all timed quantities and the reference work (NumPy and SciPy alone) in turn, in blocks of a "
    "tenth of a second. A quantity is divided, block by block, by the references of its own texture, so that a machine "
    "that slows down slows both; blocks are condensed to one ratio a process (mean of the logarithms without the "
    "highest and the lowest tenth), and processes to a trimmed mean. Waiting for a core is not counted, sleeping is. "
    "A quantity is called slower where it exceeds its baseline by more than the margin. Processes are added until "
    "every quantity is two standard errors from its limit on one side, or the most that the gate file allows are done."
)


def check_page(verdict: CheckVerdict, history: Sequence[HistoryEntry], origin: Origin) -> Page:
    """Return the page of a check; `history` has this check as its last entry."""
    status = "good" if verdict.passed else "failed"
    return Page(
        title=f"Regression check: {verdict.gate}",
        subtitle=f"Values against {verdict.accuracy_source}; times against {verdict.timing_source}",
        verdict=Verdict(status, verdict.headline(), verdict.failures()),
        facts=_facts(origin, verdict),
        notices=_notices(verdict),
        sections=[
            _timing_section(verdict),
            _accuracy_section(verdict),
            _trend_section(trends(history, origin.machine.processor, against=verdict.against is not None)),
            method_section(verdict),
        ],
        downloads=(
            Download("check.json", "the check for programs", media_type="application/json"),
            Download("tables/rounds.csv", "the ratio of every measured process"),
            Download("tables/accuracy.csv", "the gated values"),
        ),
        footer=f"tissuebench {origin.environment['packages']['tissuebench']}",
    )


def _notices(verdict: CheckVerdict) -> tuple[Notice, ...]:
    if not verdict.warnings:
        return ()
    return (Notice("warning", "Read these before you trust the verdict.", verdict.warnings),)


def _facts(origin: Origin, verdict: CheckVerdict) -> tuple[Fact, ...]:
    found = origin.environment
    return (
        Fact("Made", origin.made),
        Fact("Revision", origin.revision or "not in a repository"),
        Fact("On", f"{found['processor']}, {found['usable_cores']} cores, one thread a process"),
        Fact("Measured processes", f"{verdict.rounds} of each side"),
    )


def _timing_section(verdict: CheckVerdict) -> Section:
    if not verdict.timing:
        return Section("Time", (Paragraph("This gate times nothing."),))
    columns = (
        "quantity",
        Column("baseline"),
        Column("now"),
        "95 % interval",
        Column("change", "%", 2),
        Column("allowed"),
        Column("caught from", "%", 2),
        "verdict",
    )
    rows: list[tuple[Any, ...]] = [
        (
            row.quantity,
            row.baseline,
            row.now,
            f"{row.ci95[0]:.4g} to {row.ci95[1]:.4g}",
            100.0 * row.slowdown,
            row.allowed,
            100.0 * row.caught,
            "slower" if not row.passed else "faster" if row.faster else "within limits",
        )
        for row in verdict.timing
    ]
    caption = (
        "Time of each quantity in units of its references; a slowdown is caught in 19 of 20 checks from the size in "
        "the last column but one"
    )
    return Section("Time", (Table(caption, columns, rows, folded=False),))


def _accuracy_section(verdict: CheckVerdict) -> Section:
    columns = (
        "quantity",
        "unit",
        Column("baseline", digits=8),
        Column("now", digits=8),
        Column("allowed difference", digits=3),
        "verdict",
    )
    rows = [
        (row.label, row.unit, row.baseline, row.now, row.allowed, "within limits" if row.passed else "changed")
        for row in verdict.accuracy
    ]
    return Section("Accuracy", (Table("Gated values", columns, rows, folded=False),))


def _trend_section(found: Sequence[Trend]) -> Section:
    if not found:
        text = "The trend begins with the second check on this machine."
        return Section("Trend", (Paragraph(text),))
    skipped = "Checks on other machines, or compared in another way, are in the history file but not in this figure."
    return Section("Trend", (trend_figure(found), Bullets((skipped,))))


def method_section(verdict: CheckVerdict) -> Section:
    """Return the section on method, with the chances of error at the scatter seen in this check."""
    if not verdict.timing:
        return Section("Method", (Paragraph(HOW),))
    columns = (
        "quantity",
        Column("margin", "%", 3),
        Column("standard error", "%", 2),
        "chance of a false alarm",
        "chance to miss twice the margin",
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
        missed = 1.0 - power(math.log1p(row.wanted), limit, noise)
        chances = (_chance(false_alarm(limit, noise)), _chance(missed))
    return (row.quantity, 100.0 * math.expm1(limit), 100.0 * noise, *chances)


def _chance(value: float) -> str:
    """A chance in words; below one in a million no normal distribution is to be believed."""
    return f"below {LEAST:g}" if value < LEAST else f"{value:.2g}"
