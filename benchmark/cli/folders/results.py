"""`benchmark report`, `dossier` and `clean`: finished folders once more, together, and what killed runs left behind."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet

if TYPE_CHECKING:
    from benchmark.gate.history.history_page import HistoryOutcome
    from benchmark.runs.finished import ReportOutcome

Runs = Annotated[list[Path], typer.Argument(help="Result folders of `run`, or the history of `check` (.jsonl).")]
Results = Annotated[
    list[Path], typer.Argument(metavar="RESULT...", help="Folders of run, fit, discover, verify, check and sweep.")
]
ContextFile = Annotated[
    Path | None, typer.Option("--context", metavar="FILE", help="What the model is asked for, and what hangs on it.")
]
Folder = Annotated[Path, typer.Argument(help="Where to look, there and below.")]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Say what is there and remove nothing.")]
HISTORY = ".jsonl"


def register(app: typer.Typer) -> None:
    """Add the verbs to the command line."""
    app.command("report", help=report.__doc__)(report)
    app.command("dossier", help=dossier.__doc__)(dossier)
    app.command("clean", help=clean.__doc__)(clean)


def report(runs: Runs, out: Out = None, json: Json = False, quiet: Quiet = False, debug: Debug = False) -> int:
    """Make the page of a finished RUN again from its files, or set several side by side.

    With one RUN its report.html is written anew; with several, a folder with report.html, tables/runs.csv and
    report.json: parameters changed, results changed, figures laid over each other. A history that `check` keeps
    becomes a page with every quantity by commit and its steps marked.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json

    history = len(runs) == 1 and runs[0].suffix == HISTORY
    outcome = _history(runs[0], out) if history else _of_runs(runs, out)
    console = Console(quiet=quiet)
    for warning in outcome.warnings:
        console.say(f"  warning: {warning}")
    if json:
        print_json({**outcome.document, "out": str(outcome.folder)})
    else:
        print(f"{outcome.headline}\n  report: {outcome.folder / 'report.html'}")
    return 0


def _of_runs(runs: list[Path], out: Path | None) -> ReportOutcome:
    from benchmark.runs.finished import compare_runs, page_again

    return page_again(runs[0], out) if len(runs) == 1 else compare_runs(runs, out)


def _history(path: Path, out: Path | None) -> HistoryOutcome:
    from benchmark.gate.history.history_page import write_history

    return write_history(path, out)


def dossier(
    results: Results,
    context: ContextFile = None,
    out: Out = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Collect what finished results show for each credibility factor of ASME V&V 40, and what is missing.

    Writes report.html, dossier.json and tables/evidence.csv. Nothing is computed anew.
    """
    from benchmark.cli.show import print_json
    from benchmark.dossier import make_dossier

    made = make_dossier(results, context, out)
    if json:
        print_json({**made.document, "out": str(made.folder)})
    else:
        print(f"{made.headline}.\n  report: {made.folder / 'report.html'}")
    return 0


def clean(
    folder: Folder = Path(), dry_run: DryRun = False, json: Json = False, quiet: Quiet = False, debug: Debug = False
) -> int:
    """Remove what killed runs left: half-written files and folders, locks, and the steps kept to go on from.

    Results, recordings, and whatever this program did not write stay. A run that is at work is left alone. After this
    a stopped run begins anew instead of going on.
    """
    from benchmark.cli.show import print_json
    from benchmark.errors import InputError
    from benchmark.files.sessions.session_folder import recover_command
    from benchmark.litter import find_litter, fortune, remove, unclosed_recordings

    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such folder to clean")
    found = list(find_litter(folder))
    gone = [] if dry_run else [litter for litter in found if remove(litter)]
    cut, live = unclosed_recordings(folder)
    if json:
        rows = [{"path": str(each.path), "what": each.what, "bytes": each.size, "goes": each.goes} for each in found]
        paths = {"removed": [each.path for each in gone], "recordings": cut, "being_recorded": live}
        print_json({"schema": 1, "found": rows, **{key: list(map(str, each)) for key, each in paths.items()}})
        return 0
    for each in found:
        print(f"{each.path}: {each.what}, {each.size / 1e6:.1f} MB, {fortune(each, None if dry_run else each in gone)}")
    for path in cut:
        print(f"{path}: a recording that was cut off, stays; {recover_command(path)}")
    for path in live:
        print(f"{path}: is being recorded, left alone")
    if not (found or cut or live):
        print(f"{folder}: nothing to clean")
    return 0
