"""`benchmark dossier`: what finished results show of a model's credibility."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json, Out

Results = Annotated[
    list[Path], typer.Argument(metavar="RESULT...", help="Folders of run, fit, discover, verify, check and sweep.")
]
ContextFile = Annotated[
    Path | None, typer.Option("--context", metavar="FILE", help="What the model is asked for, and what hangs on it.")
]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("dossier", help=dossier.__doc__)(dossier)


def dossier(
    results: Results, context: ContextFile = None, out: Out = None, json: Json = False, debug: Debug = False
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
