"""A result folder, written whole or not at all."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.model_file import model_toml
from benchmark.runs.fields import write_fields, write_last
from benchmark.runs.output.destination import file_name
from benchmark.runs.output.document import describe_environment, results_document
from benchmark.runs.output.pressed import draw, pressed_picture, write_drawn
from benchmark.runs.record import RunRecord
from benchmark.runs.report import TrialsPart, run_page
from benchmark.runs.report.film_section import write_film
from benchmark.runs.tables import run_tables
from reports import csv_text, write_json, write_page, write_text, write_whole


@dataclass(frozen=True)
class RunOutcome:
    """A finished run on disk.

    Attributes
    ----------
    folder
        The result folder.
    document
        The content of `results.json`.
    headline
        The verdict in one sentence.
    complete
        False where a solver stopped early.
    warnings
        What the reader must know.
    """

    folder: Path
    document: dict[str, Any]
    headline: str
    complete: bool
    warnings: tuple[str, ...]

    @property
    def report(self) -> Path:
        """The page."""
        return self.folder / "report.html"


def write_run(record: RunRecord, folder: Path) -> RunOutcome:
    """Write tables, JSON, resolved scenario, fields and report of a run into `folder`.

    Raises
    ------
    OSError
        Where the file system refuses; `folder` is then as it was.
    """
    document, environment = results_document(record), describe_environment(seed=record.seed)
    tables = run_tables(record)
    texts = {name: csv_text(columns, where=name) for name, columns in tables.items()}
    trials = None if record.measured is None else TrialsPart.of(record.measured)
    drawn = draw(record)
    page = run_page(record, environment, texts, trials, tables, pressed_picture(record, drawn))
    document["verdict"] = {"status": page.verdict.status, "headline": page.verdict.headline}

    def fill(new: Path) -> None:
        for name, text in texts.items():
            write_text(new / "tables" / name, text)
        if trials is not None and trials.markers is not None:
            write_film(new / "markers", trials.markers)
        write_json(new / "results.json", document)
        write_json(new / "environment.json", environment)
        write_text(new / "scenario.toml", record.scenario.to_toml())
        for ending, text in record.exported:
            write_text(new / f"{file_name(record.scenario.name)}.{ending}", text)
        if record.repair is not None:
            write_text(new / "model.toml", model_toml(record.repair))
        fem = record.pair.fem.result
        write_fields(new / "fields", fem.fields if fem is not None else ())
        write_last(new / "fields", None if fem is None else fem.last)
        write_drawn(new, drawn)
        write_page(new / "report.html", page)

    write_whole(folder, fill)
    return RunOutcome(folder, document, page.verdict.headline, record.complete, record.warnings)
