"""`benchmark fit`: the parameters of a specimen from its trials."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Seed, Set, parse_settings, say_names

Sessions = Annotated[
    list[Path], typer.Argument(help="A trial session, a folder or a shipped name; several with --free.")
]
Specimen = Annotated[str | None, typer.Option("--specimen", help="Tissue of the trials: a name or a TOML file.")]
Model = Annotated[Path | None, typer.Option("--model", help="Switch on the effects of a model file of discover.")]
Effects = Annotated[Path | None, typer.Option("--effects", help="Effects of your own that the model file names.")]
Free = Annotated[
    str | None, typer.Option("--free", help="Parameters to fit, KEY,KEY: dermis.youngs_modulus,fat.thickness...")
]
Law = Annotated[
    str | None,
    typer.Option("--law", help="Law of all layers: yeoh, gent... Several, or auto: held-out conditions choose."),
]
Forward = Annotated[str | None, typer.Option("--forward", help="Model that is fitted: fem (default) or wave.")]
Exact = Annotated[str | None, typer.Option("--exact", help="Told values to take as exact, KEY,KEY, or all.")]
Discrepancy = Annotated[
    str | None, typer.Option("--discrepancy", help='Let the model be wrong over depth by so much, "1 %" of the force.')
]
Markers = Annotated[
    bool | None, typer.Option("--markers/--no-markers", help="Fit parameters to markers over a hole, too (default).")
]
Posterior = Annotated[bool, typer.Option("--posterior", help="Draw from the posterior (with emcee).")]
Export = Annotated[
    str | None,
    typer.Option(
        "--export", help="Write what was identified for another code, too: inp (CalculiX, Abaqus), feb (FEBio)."
    ),
]
FitFile = Annotated[Path | None, typer.Option("--fit-file", help="A TOML file with a [fit] table.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("fit", help=fit.__doc__)(fit)


def fit(
    sessions: Sessions,
    specimen: Specimen = None,
    model: Model = None,
    effects: Effects = None,
    free: Free = None,
    law: Law = None,
    forward: Forward = None,
    exact: Exact = None,
    fit_file: FitFile = None,
    discrepancy: Discrepancy = None,
    markers: Markers = None,
    posterior: Posterior = False,
    export: Export = None,
    out: Out = None,
    settings: Set = None,
    seed: Seed = 0,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Fit the specimen of a trial session and say what the trials can tell.

    Writes fit.json, fitted_parameters.csv and report.html; with --free also identified.toml, a tissue file. A fit
    that does not settle is written, too, and ends with exit code 4.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json
    from benchmark.errors import SolverError
    from benchmark.runs import FitRequest, fit_to_folder
    from benchmark.runs.parameters_run import ParameterWish

    console = Console(quiet=quiet)
    say_names(console, tissues=(specimen,), sessions=sessions)
    files = tuple(sessions[1:]), fit_file
    wish = ParameterWish(_keys(free), _keys(exact), _laws(law), forward, *files, discrepancy, markers, posterior, seed)
    request = FitRequest(
        sessions[0], specimen, parse_settings(settings), model, effects, seed, wish, _keys(export) or ()
    )
    outcome = fit_to_folder(request, out, console)
    for warning in outcome.warnings:
        console.say(f"  warning: {warning}")
    if json:
        print_json({**outcome.document, "out": str(outcome.folder)})
    else:
        print(f"{outcome.headline}\n  report: {outcome.folder / 'report.html'}")
    if not outcome.settled:
        raise SolverError(f"the fit did not settle; what it came to is in {outcome.folder}, marked settled = false")
    return 0


def _keys(text: str | None) -> tuple[str, ...] | None:
    """Keys of a list with commas."""
    return None if text is None else tuple(key.strip() for key in text.split(",") if key.strip())


def _laws(text: str | None) -> tuple[str, ...] | None:
    """Laws of a list with commas; all of them for `auto`."""
    if text != "auto":
        return _keys(text)
    from benchmark.identification.parameters.law_shapes import LAW_SHAPES

    return tuple(LAW_SHAPES)
