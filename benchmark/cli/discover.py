"""`benchmark discover`: where simulation and measurement disagree, which effect is missing, what it closes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Seed, Set, parse_settings

Paths = Annotated[
    list[Path],
    typer.Argument(
        metavar="SESSION_OR_RUN...",
        help="A trial session (a folder, or a shipped name); or a result folder of run, and a second one to hold out.",
    ),
]
Model = Annotated[Literal["wave", "fem"], typer.Option("--model", help="The model under repair.")]
Effects = Annotated[
    Path | None, typer.Option("--effects", help="Effects of your own beside the catalogue: a Python file.")
]
Specimen = Annotated[str | None, typer.Option("--specimen", help="Tissue of the trials: a name or a TOML file.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("discover", help=discover.__doc__)(discover)


def discover(
    paths: Paths,
    model: Model = "wave",
    effects: Effects = None,
    specimen: Specimen = None,
    out: Out = None,
    settings: Set = None,
    seed: Seed = 0,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Find where simulation and measurement disagree and name the effect that is missing.

    Writes discovery.json, model.toml (for run --model), tables, report.html, and next_experiment.toml where rivals
    remain. With a result folder of run in the place of a session, the wave model is repaired against its FEM.
    Exit code 0 whatever is found.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import show_discovery
    from benchmark.discovery.discovery_request import DiscoverRequest, carry_out

    console = Console(quiet=quiet)
    request = DiscoverRequest(paths, model, effects, specimen, parse_settings(settings), out, seed)
    outcome = carry_out(request, console)
    return show_discovery(outcome, console, as_json=json)
