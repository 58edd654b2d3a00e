"""`benchmark report`: the page of a finished run once more, or of several side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet

Runs = Annotated[list[Path], typer.Argument(help="Result folders of `run`: one, or several to set side by side.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("report", help=report.__doc__)(report)


def report(runs: Runs, out: Out = None, json: Json = False, quiet: Quiet = False, debug: Debug = False) -> int:
    """Make the page of a finished RUN again from its files, or set several side by side.

    With one RUN its report.html is written anew; with several, a folder with report.html, tables/runs.csv and
    report.json: parameters changed, results changed, figures laid over each other.
    """
    from benchmark.cli.show import print_json
    from benchmark.runs.finished import compare_runs, page_again

    outcome = page_again(runs[0], out) if len(runs) == 1 else compare_runs(runs, out)
    if json:
        print_json({**outcome.document, "out": str(outcome.folder)})
    else:
        print(f"{outcome.headline}\n  report: {outcome.folder / 'report.html'}")
    return 0
