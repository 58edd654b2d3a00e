"""The rows of `verify`: for a terminal, for programs, as columns, as a page, and all of it as a result folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmark.runs.output.document import describe_environment
from benchmark.verification.cases import VerificationRow
from reports import (
    Column,
    Download,
    Fact,
    KeyFigure,
    Listing,
    Notice,
    Page,
    Paragraph,
    Section,
    Table,
    Verdict,
    write_csv,
    write_json,
    write_page,
    write_whole,
)
from reports.formatting import format_number

SCHEMA = 1
HEADINGS = ("case", "reference", "ours", "unit", "error %", "allowed %", "unknowns", "seconds", "", "source")
TEXT_COLUMNS = (0, 3, 8, 9)
NOTHING = "-"
WAVE = "wave_"
HOW = (
    "The error is ours against the reference, in percent of the reference. Values of one case come from one run and "
    "show its wall time, measured once; the first case also loads the libraries. A case about the worst of many points "
    "shows that point."
)


def document(rows: Sequence[VerificationRow]) -> dict[str, Any]:
    """Return the content of `verification.json`."""
    return {"schema": SCHEMA, "cases": [row.to_dict() for row in rows]}


def columns(rows: Sequence[VerificationRow]) -> dict[str, list[Any]]:
    """Return the columns of `verification.csv`."""
    table = [row.to_dict() for row in rows]
    return {key: [entry[key] for entry in table] for key in table[0]}


def headline(rows: Sequence[VerificationRow]) -> str:
    """Return the outcome in one sentence."""
    failed = sum(not row.passed for row in rows)
    if failed:
        return f"{failed} of {len(rows)} verification values are outside what is allowed"
    return f"All {len(rows)} verification values are within what is allowed"


def text_table(rows: Sequence[VerificationRow]) -> str:
    """Return an aligned table, a line a row, numbers to the right."""
    lines = [HEADINGS, *(_cells(row) for row in rows)]
    widths = [max(len(line[column]) for line in lines) for column in range(len(HEADINGS))]
    return "\n".join(_line(line, widths) for line in lines)


def signed_error(error: float) -> str:
    """Return an error in percent with its sign; what is round-off stays recognisable as such."""
    return f"{error:+.1e}" if 0.0 < abs(error) < 1e-4 else f"{error:+.4f}"


def _cells(row: VerificationRow) -> tuple[str, ...]:
    found, verdict = row.quantity, "ok" if row.passed else "FAILED"
    seconds = f"{row.seconds:.2f}"
    if found is None:
        return (row.case, *(NOTHING,) * 2, "", *(NOTHING,) * 3, seconds, verdict, row.source)
    return (
        row.case,
        _number(found.reference),
        _number(found.ours),
        found.unit,
        signed_error(found.error_percent),
        f"{found.allowed_percent:.4g}",
        str(found.unknowns),
        seconds,
        verdict,
        row.source,
    )


def _number(value: float) -> str:
    """Return six digits with a plain minus, so that a line can be copied into a program."""
    return format_number(value, 6).replace("\N{MINUS SIGN}", "-")


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    padded = (
        cell.ljust(width) if column in TEXT_COLUMNS else cell.rjust(width)
        for column, (cell, width) in enumerate(zip(cells, widths, strict=True))
    )
    return "  ".join(padded).rstrip()


COLUMNS = (
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


def verification_page(rows: Sequence[VerificationRow], environment: Mapping[str, Any]) -> Page:
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


def _key_figures(rows: Sequence[VerificationRow]) -> list[KeyFigure]:
    """How many values are good, and which one is nearest to its bar."""
    passed = sum(row.passed for row in rows)
    figures = [KeyFigure("Values within what is allowed", f"{passed} of {len(rows)}")]
    found = [(row.case, row.quantity) for row in rows if row.quantity is not None]
    if found:
        name, nearest = max(found, key=lambda entry: entry[1].share_of_allowed)
        figures.append(KeyFigure("Nearest to its bar", 100.0 * nearest.share_of_allowed, "% of what is allowed", name))
    return figures


def _tables(rows: Sequence[VerificationRow]) -> list[Table]:
    """One table for each family and source."""
    groups: dict[tuple[str, str], list[VerificationRow]] = {}
    for row in rows:
        groups.setdefault((row.case.partition("/")[0], row.source), []).append(row)
    return [
        Table(f"{family.replace('_', ' ')}: {source}", COLUMNS, [_row_values(row) for row in group], folded=False)
        for (family, source), group in groups.items()
    ]


def _row_values(row: VerificationRow) -> tuple[Any, ...]:
    entry = row.to_dict()
    error = None if row.quantity is None else signed_error(row.quantity.error_percent)
    values = (entry[key] for key in ("case", "reference", "ours", "unit"))
    return (*values, error, *(entry[key] for key in ("allowed_percent", "unknowns", "seconds", "passed")))


def _reasons(rows: Sequence[VerificationRow]) -> list[str]:
    return [f"{row.case}: {row.reason}" for row in rows if row.reason]


def write_verification(rows: Sequence[VerificationRow], folder: Path) -> Path:
    """Write verification.json, verification.csv and report.html; return the page's path.

    Raises
    ------
    OSError
        Where the file system refuses; `folder` is then as it was.
    """

    def fill(new: Path) -> None:
        write_json(new / "verification.json", document(rows))
        write_csv(new / "verification.csv", columns(rows))
        write_page(new / "report.html", verification_page(rows, describe_environment(seed=0)))

    write_whole(folder, fill)
    return folder / "report.html"
