"""`benchmark report`: the page of a finished run once more, of several side by side, or of the gate's history."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet

if TYPE_CHECKING:
    from benchmark.gate.history.history_page import HistoryOutcome
    from benchmark.runs.finished import ReportOutcome

Runs = Annotated[list[Path], typer.Argument(help="Result folders of `run`, or the history of `check` (.jsonl).")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("report", help=report.__doc__)(report)


def report(runs: Runs, out: Out = None, json: Json = False, quiet: Quiet = False, debug: Debug = False) -> int:
    """Make the page of a finished RUN again from its files, or set several side by side.

    With one RUN its report.html is written anew; with several, a folder with report.html, tables/runs.csv and
    report.json: parameters changed, results changed, figures laid over each other. A history that `check` keeps
    becomes a page with every quantity by commit and its steps marked.
    """
    from benchmark.cli.show import print_json

    outcome = _history(runs[0], out) if len(runs) == 1 and runs[0].suffix == HISTORY else _of_runs(runs, out)
    if json:
        print_json({**outcome.document, "out": str(outcome.folder)})
    else:
        print(f"{outcome.headline}\n  report: {outcome.folder / 'report.html'}")
    return 0


HISTORY = ".jsonl"


def _of_runs(runs: list[Path], out: Path | None) -> ReportOutcome:
    from benchmark.runs.finished import compare_runs, page_again

    return page_again(runs[0], out) if len(runs) == 1 else compare_runs(runs, out)


def _history(path: Path, out: Path | None) -> HistoryOutcome:
    from benchmark.gate.history.history_page import write_history

    return write_history(path, out)
