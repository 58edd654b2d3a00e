"""The folder of a blind run: its settings, the journal while it runs, the tables once all cases are finished."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from benchmark.blind.scoring.judging import Judged, confusion, table, verdicts
from benchmark.blind.scoring.lab_measures import lab_table
from benchmark.blind.scoring.measure_rows import BlindRow
from benchmark.blind.scoring.scoreboard import scoreboard
from benchmark.blind.suites import MIXED
from benchmark.errors import InputError
from benchmark.resumable import begun, check_files, code_version
from benchmark.runs.output.destination import check_ready
from benchmark.runs.output.document import describe_environment
from reports import extended_folder, write_csv, write_json, write_page, write_text
from reports.manifest import read_manifest
from reports.result_folder import clear_leftovers, settle

SCHEMA = 1
SETTINGS, JOURNAL, DOCUMENT = "settings.json", "cases.jsonl", "blind.json"
FILES = (SETTINGS, DOCUMENT, "cases.csv", "confusion.csv", "table.md", "report.html", JOURNAL)


def open_folder(path: Path, settings: dict[str, Any]) -> Path:
    """Take a new or empty folder, or that of an earlier result, which steps aside; a stopped blind run goes on.

    Returns
    -------
    Path
        Of the journal.

    Raises
    ------
    InputError
        The folder holds something else, or a stopped run with other settings or of other code.
    """
    check_ready(path)
    manifest = read_manifest(path)
    stopped = manifest is not None and JOURNAL in manifest.growing
    check_files(path, FILES, resumed=stopped, no="no blind run")
    there, asked = _settings_in(path), {**settings, "code_sha256": code_version()}
    if stopped and there != asked:
        other = "other settings" if there is None or {**there, **settings} != there else "other code of the program"
        raise InputError(
            f"--out {path} holds a stopped blind run with {other} ({there}); repeat that command to go on with "
            "it, or give another folder"
        )
    if stopped:
        clear_leftovers(path)
        return path / JOURNAL
    with begun(path, "blind run", (JOURNAL,)) as new:
        write_json(new / SETTINGS, asked)
    return path / JOURNAL


def _settings_in(path: Path) -> dict[str, Any] | None:
    try:
        table: dict[str, Any] = json.loads((path / SETTINGS).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return table


def finish(path: Path, settings: dict[str, Any], cases: Sequence[Judged]) -> dict[str, Any]:
    """Write the page, tables and blind.json, and end the journal; returns the document."""
    rows = rows_of(settings, cases)
    result = document(settings, rows, cases)
    columns = {each.name: [getattr(case, each.name) for case in cases] for each in fields(Judged)}
    pairs = [(truth, said, n) for truth, names in confusion(cases).items() for said, n in names.most_common()]
    confused = {name: [pair[number] for pair in pairs] for number, name in enumerate(("truth", "said_first", "cases"))}
    with extended_folder(path) as new:
        write_csv(new / "cases.csv", columns)
        write_csv(new / "confusion.csv", confused)
        write_text(new / "table.md", f"# Blind trials (synthetic), suite {settings['suite']}\n\n{text_table(rows)}\n")
        write_page(new / "report.html", scoreboard(settings, rows, cases, describe_environment(seed=settings["seed"])))
        write_json(new / DOCUMENT, result)
    (path / JOURNAL).unlink(missing_ok=True)
    settle(path)
    return result


def rows_of(settings: dict[str, Any], cases: Sequence[Judged]) -> tuple[BlindRow, ...]:
    """The measures of a run; those over labs and families where its suite has them."""
    return (*table(cases), *(lab_table(cases) if settings["suite"] in MIXED else ()))


def document(settings: dict[str, Any], rows: Sequence[BlindRow], cases: Sequence[Judged]) -> dict[str, Any]:
    """What `--json` prints."""
    return {
        "schema": SCHEMA,
        "synthetic": True,
        **settings,
        "rows": [row.to_dict() for row in rows],
        "verdicts": dict(verdicts(cases)),
        "confusion": {truth: dict(names) for truth, names in confusion(cases).items()},
    }


def text_table(rows: Sequence[BlindRow]) -> str:
    """The rows as a Markdown table."""
    lines = ["| measure | value | 95 % | cases | bar | passed |", "|---|---|---|---|---|---|"]
    for row in rows:
        if not row.n:
            lines.append(f"| {row.measure} | not measured |  | 0 | {row.bar} |  |")
            continue
        passed = "" if row.passed is None else "yes" if row.passed else "no"
        low, high = row.ci95
        lines.append(f"| {row.measure} | {row.value:.3g} | {low:.3g} to {high:.3g} | {row.n} | {row.bar} | {passed} |")
    return "\n".join(lines)


def confusion_text(cases: Sequence[Judged]) -> str:
    """A line for each truth that was taken for something else."""
    lines = []
    for truth, names in sorted(confusion(cases).items()):
        others = [f"{said} {n}" for said, n in names.most_common() if said != truth]
        if others:
            lines.append(f"  {truth}: {', '.join(others)}")
    return "\n".join(lines)
