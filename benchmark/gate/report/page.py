"""The page of a check: verdict, what is compared with what, trend, method."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmark.gate.history import Entry
from benchmark.gate.origin import Origin
from benchmark.gate.report.method import method_section
from benchmark.gate.report.trend import Trend, trend_figure, trends
from benchmark.gate.verdict import Verdict
from reports import Bullets, Column, Download, Fact, Notice, Page, Paragraph, Section, Table
from reports import Verdict as PageVerdict


def check_page(verdict: Verdict, history: Sequence[Entry], origin: Origin) -> Page:
    """Return the page of a check; `history` has this check as its last entry."""
    status = "good" if verdict.passed else "failed"
    return Page(
        title=f"Regression check: {verdict.gate}",
        subtitle=f"Values against {verdict.accuracy_source}; times against {verdict.timing_source}",
        verdict=PageVerdict(status, verdict.headline(), verdict.failures()),
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


def _notices(verdict: Verdict) -> tuple[Notice, ...]:
    if not verdict.warnings:
        return ()
    return (Notice("warning", "Read these before you trust the verdict.", verdict.warnings),)


def _facts(origin: Origin, verdict: Verdict) -> tuple[Fact, ...]:
    found = origin.environment
    return (
        Fact("Made", origin.made),
        Fact("Revision", origin.revision or "not in a repository"),
        Fact("On", f"{found['processor']}, {found['usable_cores']} cores, one thread a process"),
        Fact("Measured processes", f"{verdict.rounds} of each side"),
    )


def _timing_section(verdict: Verdict) -> Section:
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
            "as allowed" if row.passed else "slower",
        )
        for row in verdict.timing
    ]
    caption = (
        "Time of each quantity in units of its references; a slowdown is caught in 19 of 20 checks from the size in "
        "the last column but one"
    )
    return Section("Time", (Table(caption, columns, rows, folded=False),))


def _accuracy_section(verdict: Verdict) -> Section:
    columns = (
        "quantity",
        "unit",
        Column("baseline", digits=8),
        Column("now", digits=8),
        Column("allowed difference", digits=3),
        "verdict",
    )
    rows = [
        (row.quantity, row.unit, row.baseline, row.now, row.allowed, "as allowed" if row.passed else "changed")
        for row in verdict.accuracy
    ]
    return Section("Accuracy", (Table("Gated values", columns, rows, folded=False),))


def _trend_section(found: Sequence[Trend]) -> Section:
    if not found:
        text = "The trend begins with the second check on this machine."
        return Section("Trend", (Paragraph(text),))
    skipped = "Checks on other machines, or compared in another way, are in the history file but not in this figure."
    return Section("Trend", (trend_figure(found), Bullets((skipped,))))
