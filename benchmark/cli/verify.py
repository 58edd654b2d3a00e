"""`benchmark verify`: the models against published values and closed forms."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from benchmark.cli.options import Debug, Json, Quiet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmark.cli.console import Console
    from benchmark.verification.cases import VerificationRow

Cases = Annotated[
    list[str] | None,
    typer.Argument(metavar="CASE", help="Families, cases or single values, as printed; all by default."),
]
Folder = Annotated[Path | None, typer.Option("--out", help="Folder for the table and a report; none by default.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("verify", help=verify.__doc__)(verify)


def verify(
    cases: Cases = None, out: Folder = None, json: Json = False, quiet: Quiet = False, debug: Debug = False
) -> int:
    """Run the verification cases and print each one's source, reference, our value and error.

    Exit code 1 where a value is outside what is allowed. With --out also verification.json, verification.csv and
    report.html.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json
    from benchmark.errors import GateError
    from benchmark.runs.output.destination import claimed, destination
    from benchmark.verification.verification_page import document, headline, text_table, write_verification

    console = Console(quiet=quiet)
    with claimed(out, "verify"):
        folder = None if out is None else destination(out, "verification")
        rows = _run(cases or [], console)
        report = None if folder is None else write_verification(rows, folder)
    for row in rows:
        if row.reason:
            console.say(f"  warning: {row.case}: {row.reason}")
    if json:
        print_json(document(rows))
    else:
        print(f"{text_table(rows)}\n\n{headline(rows)}.")
        if report is not None:
            print(f"  report: {report}")
    failed = [row.case for row in rows if not row.passed]
    if failed:
        raise GateError(f"verification failed: {', '.join(failed)}")
    return 0


def _run(names: Sequence[str], console: Console) -> tuple[VerificationRow, ...]:
    """Run what is named, with progress."""
    from benchmark.verification.cases import all_cases, run_cases, select

    chosen = select(all_cases(), names)
    with console.progress("verification") as advance:
        rows = run_cases(chosen, names, lambda case, number: advance("cases", number, len(chosen), case.name))
        advance("cases", len(chosen), len(chosen), "")
    return rows
