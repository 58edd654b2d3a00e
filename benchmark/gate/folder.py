"""The result folder of a check: `check.json`, tables, report, written whole or not at all."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmark.gate.baseline import HistoryEntry
from benchmark.gate.check_page import check_page
from benchmark.gate.processes import Measured
from benchmark.gate.verdict import CheckVerdict
from benchmark.gate.versions import Origin
from reports import whole_folder, write_csv, write_json, write_page

DOCUMENT = "check.json"


def write_check(
    folder: Path, verdict: CheckVerdict, measured: Measured, history: Sequence[HistoryEntry], origin: Origin
) -> dict[str, Any]:
    """Write a check and return the content of `check.json`.

    Raises
    ------
    OSError
        Where the file system refuses; `folder` is then as it was.
    """
    document = {**verdict.to_dict(), "revision": origin.revision}
    page = check_page(verdict, history, origin)
    with whole_folder(folder) as new:
        write_json(new / DOCUMENT, document)
        write_json(new / "environment.json", origin.environment)
        write_csv(new / "tables" / "accuracy.csv", _columns([row.to_dict() for row in verdict.accuracy]))
        write_csv(new / "tables" / "rounds.csv", round_columns(measured))
        write_page(new / "report.html", page)
    return document


def round_columns(measured: Measured) -> dict[str, list[Any]]:
    """Every measured process: side, its number, quantity, and time in units of its references."""
    rows = [
        (side, number, quantity, math.exp(value))
        for side, ratios in zip(("now", "against"), measured.ratios, strict=False)
        for quantity, values in ratios.items()
        for number, value in enumerate(values, start=1)
    ]
    names = ("side", "process", "quantity", "ratio")
    return {name: [row[column] for row in rows] for column, name in enumerate(names)}


def _columns(rows: Sequence[Mapping[str, Any]]) -> dict[str, list[Any]]:
    return {name: [row[name] for row in rows] for name in rows[0]}
