"""`report`: pages made from finished runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.runs.finished.comparison_page import Columns, changed_parameters, compare_page, result_columns
from benchmark.runs.finished.saved_run import SavedRun, read_run
from benchmark.runs.output.destination import claimed, destination, file_name
from benchmark.runs.output.document import describe_environment
from benchmark.runs.output.pressed import pressed_picture, read_drawn, write_drawn
from benchmark.runs.report import run_page
from reports import csv_text, extended_folder, write_json, write_page, write_text, write_whole


@dataclass(frozen=True)
class ReportOutcome:
    """A page on disk: its folder, what it says in one sentence, the same for programs, and what must be known first."""

    folder: Path
    headline: str
    document: dict[str, Any]
    warnings: tuple[str, ...] = ()


def page_again(folder: Path, out: Path | None) -> ReportOutcome:
    """Write the page of a finished run anew, into the run's folder or into `out`.

    Raises
    ------
    InputError
        The folder is no result of `run`; see `read_run`.
    """
    with claimed(folder if out is None else out, "report"):
        return _page_again(folder, out)


def _page_again(folder: Path, out: Path | None) -> ReportOutcome:
    target = folder if out is None else destination(out, "", (folder,))
    run = read_run(folder)
    drawn = read_drawn(folder)
    picture, warnings = pressed_picture(run.record, drawn), _changed([run])
    page = run_page(run.record, run.environment, run.tables, run.trials, run.columns, picture)
    if out is None:
        with extended_folder(folder) as new:
            write_page(new / "report.html", page)
        return ReportOutcome(folder, page.verdict.headline, run.document, warnings)

    def fill(new: Path) -> None:
        for name, text in run.tables.items():
            write_text(new / "tables" / name, text)
        for name in ("results.json", "environment.json", "scenario.toml"):
            write_text(new / name, (folder / name).read_text(encoding="utf-8"))
        if warnings:
            write_json(new / "results.json", run.document)
        write_drawn(new, drawn)
        write_page(new / "report.html", page)

    write_whole(target, fill)
    return ReportOutcome(target, page.verdict.headline, run.document, warnings)


def _changed(runs: Iterable[SavedRun]) -> tuple[str, ...]:
    return tuple(run.changed for run in runs if run.changed)


@dataclass(frozen=True)
class RunsSideBySide:
    """Finished runs by what pages call them, with the columns of `parameters.csv` and `runs.csv`."""

    runs: Mapping[str, SavedRun]
    folders: tuple[Path, ...]
    changed: Columns
    results: Columns

    def document(self) -> dict[str, Any]:
        """The content of `report.json`."""
        return {
            "schema": 1,
            "runs": [
                {"name": name, "folder": str(folder), "results": run.document}
                for (name, run), folder in zip(self.runs.items(), self.folders, strict=True)
            ],
            "parameters_changed": self.changed,
            "table": self.results,
        }


def set_side_by_side(folders: Sequence[Path]) -> RunsSideBySide:
    """Read finished runs and compare them; the first one is what the others are compared with.

    Raises
    ------
    InputError
        A folder that is no result of `run`, or one that is given twice.
    """
    if len({folder.resolve() for folder in folders}) < len(folders):
        raise InputError(f"report: {', '.join(map(str, folders))} are not different runs; give each one once")
    runs = dict(zip(_labels(folders), map(read_run, folders), strict=True))
    changed = changed_parameters({name: run.record.scenario for name, run in runs.items()})
    return RunsSideBySide(runs, tuple(folders), changed, result_columns(runs))


def compare_runs(folders: Sequence[Path], out: Path | None) -> ReportOutcome:
    """Set finished runs side by side in a folder, whose place is checked first; see `set_side_by_side`."""
    with claimed(out, "report"):
        destination(out, "", folders)
        return write_side_by_side(set_side_by_side(folders), out)


def write_side_by_side(compared: RunsSideBySide, out: Path | None) -> ReportOutcome:
    """Write `report.html`, `report.json`, `tables/runs.csv` and `tables/parameters.csv`."""
    runs, changed, columns = compared.runs, compared.changed, compared.results
    texts = {"runs.csv": csv_text(columns), "parameters.csv": csv_text(changed)}
    page = compare_page(runs, changed, columns, describe_environment(seed=0), texts)
    document = compared.document()
    target = destination(out, file_name(f"{next(iter(runs))}-compared"))

    def fill(new: Path) -> None:
        for name, text in texts.items():
            write_text(new / "tables" / name, text)
        write_json(new / "report.json", document)
        write_page(new / "report.html", page)

    write_whole(target, fill)
    return ReportOutcome(target, page.verdict.headline, document, _changed(runs.values()))


def _labels(folders: Sequence[Path]) -> list[str]:
    """What pages call the runs: the names of their folders, with as much of the path as tells them apart."""
    resolved = [folder.resolve() for folder in folders]
    for depth in range(1, max(len(folder.parts) for folder in resolved) + 1):
        names = ["/".join(folder.parts[-depth:]) for folder in resolved]
        if len(set(names)) == len(names):
            return names
    return [str(folder) for folder in resolved]
