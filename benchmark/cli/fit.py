"""`benchmark fit`: the parameters of a specimen from its trials."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Seed, Set, parse_settings

SessionFolder = Annotated[Path, typer.Argument(help="A trial session: a folder of CSV files, or a shipped name.")]
Specimen = Annotated[str | None, typer.Option("--specimen", help="Tissue of the trials: a name or a TOML file.")]
Model = Annotated[Path | None, typer.Option("--model", help="Switch on the effects of a model file of discover.")]
Effects = Annotated[Path | None, typer.Option("--effects", help="Effects of your own that the model file names.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("fit", help=fit.__doc__)(fit)


def fit(
    session: SessionFolder,
    specimen: Specimen = None,
    model: Model = None,
    effects: Effects = None,
    out: Out = None,
    settings: Set = None,
    seed: Seed = 0,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Fit the specimen of a trial session and say what the trials can tell.

    Writes fit.json, fitted_parameters.csv and report.html.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json
    from benchmark.runs import FitRequest, fit_to_folder

    console = Console(quiet=quiet)
    request = FitRequest(session, specimen, parse_settings(settings), model, effects, seed)
    outcome = fit_to_folder(request, out, console)
    for warning in outcome.warnings:
        console.say(f"  warning: {warning}")
    if json:
        print_json({**outcome.document, "out": str(outcome.folder)})
    else:
        print(f"{outcome.headline}\n  report: {outcome.folder / 'report.html'}")
    return 0
