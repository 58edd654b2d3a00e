"""The verification page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmark.verification.row import Row
from benchmark.verification.table import headline, signed_error
from reports import Column, Download, Fact, KeyFigure, Listing, Notice, Page, Paragraph, Section, Table, Verdict

WAVE = "wave_"
HEADINGS = (
    Column("case"),
    Column("reference", digits=6),
    Column("ours", digits=6),
    Column("unit"),
    Column("error", "%"),
    Column("allowed", "%"),
    Column("unknowns"),
    Column("wall time", "s", 2),
    Column("passed"),
)
HOW = (
    "The error is ours against the reference, in percent of the reference. Values of one case come from one run and "
    "show its wall time, measured once; the first case also loads the libraries. A case about the worst of many points "
    "shows that point."
)


def verification_page(rows: Sequence[Row], environment: Mapping[str, Any]) -> Page:
    """Return the page of a verification run."""
    failed = [row for row in rows if not row.passed]
    notices = [Notice("warning", "These cases could not be computed.", _reasons(rows))] if _reasons(rows) else []
    made = [row for row in rows if not row.case.startswith(WAVE)], [row for row in rows if row.case.startswith(WAVE)]
    sections = [
        Section(title, (Paragraph(HOW), *_tables(part)))
        for title, part in zip(("Finite elements", "Wave model"), made, strict=True)
        if part
    ]
    versions = "\n".join(f"{name} {version}" for name, version in environment["packages"].items())
    return Page(
        title="Verification",
        subtitle="Published values and closed forms, computed live",
        verdict=Verdict(
            "failed" if failed else "good", f"{headline(rows)}.", [f"{row.case} is outside" for row in failed]
        ),
        facts=(Fact("Made", str(environment["made"])), Fact("Processor", str(environment["processor"]))),
        notices=notices,
        key_figures=_key_figures(rows),
        sections=(*sections, Section("Method", (Listing(versions, "Versions"),))),
        downloads=(
            Download("verification.csv", "the table"),
            Download("verification.json", "the table for programs", media_type="application/json"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _key_figures(rows: Sequence[Row]) -> list[KeyFigure]:
    """How many values are good, and which one is nearest to its bar."""
    passed = sum(row.passed for row in rows)
    figures = [KeyFigure("Values within what is allowed", f"{passed} of {len(rows)}")]
    found = [(row.case, row.quantity) for row in rows if row.quantity is not None]
    if found:
        name, nearest = max(found, key=lambda entry: entry[1].share_of_allowed)
        figures.append(KeyFigure("Nearest to its bar", 100.0 * nearest.share_of_allowed, "% of what is allowed", name))
    return figures


def _tables(rows: Sequence[Row]) -> list[Table]:
    """One table for each family and source."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row.case.partition("/")[0], row.source), []).append(row)
    return [
        Table(f"{family.replace('_', ' ')}: {source}", HEADINGS, [_cells(row) for row in group], folded=False)
        for (family, source), group in groups.items()
    ]


def _cells(row: Row) -> tuple[Any, ...]:
    entry = row.to_dict()
    error = None if row.quantity is None else signed_error(row.quantity.error_percent)
    values = (entry[key] for key in ("case", "reference", "ours", "unit"))
    return (*values, error, *(entry[key] for key in ("allowed_percent", "unknowns", "seconds", "passed")))


def _reasons(rows: Sequence[Row]) -> list[str]:
    return [f"{row.case}: {row.reason}" for row in rows if row.reason]
