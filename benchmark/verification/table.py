"""The verification table: for a terminal, for programs, and as columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmark.verification.row import Row
from reports.formatting import format_number

SCHEMA = 1
HEADINGS = ("case", "reference", "ours", "unit", "error %", "allowed %", "unknowns", "seconds", "", "source")
TEXT_COLUMNS = (0, 3, 8, 9)
NOTHING = "-"


def document(rows: Sequence[Row]) -> dict[str, Any]:
    """Return the content of `verification.json`."""
    return {"schema": SCHEMA, "cases": [row.to_dict() for row in rows]}


def columns(rows: Sequence[Row]) -> dict[str, list[Any]]:
    """Return the columns of `verification.csv`."""
    table = [row.to_dict() for row in rows]
    return {key: [entry[key] for entry in table] for key in table[0]}


def headline(rows: Sequence[Row]) -> str:
    """Return the outcome in one sentence."""
    failed = sum(not row.passed for row in rows)
    if failed:
        return f"{failed} of {len(rows)} verification values are outside what is allowed"
    return f"All {len(rows)} verification values are within what is allowed"


def text_table(rows: Sequence[Row]) -> str:
    """Return an aligned table, a line a row, numbers to the right."""
    lines = [HEADINGS, *(_cells(row) for row in rows)]
    widths = [max(len(line[column]) for line in lines) for column in range(len(HEADINGS))]
    return "\n".join(_line(line, widths) for line in lines)


def signed_error(error: float) -> str:
    """Return an error in percent with its sign; what is round-off stays recognisable as such."""
    return f"{error:+.1e}" if 0.0 < abs(error) < 1e-4 else f"{error:+.4f}"


def _cells(row: Row) -> tuple[str, ...]:
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
