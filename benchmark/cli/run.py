"""`benchmark run`: FEM and wave model side by side, with or without measured trials."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Seed, Set, parse_settings, say_names

Scenario = Annotated[str | None, typer.Argument(help="A shipped scenario's name or a TOML file.")]
Trials = Annotated[
    Path | None, typer.Option("--trials", help="A trial session: a folder of CSV files, or a shipped name.")
]
Specimen = Annotated[str | None, typer.Option("--specimen", help="Tissue of the trials: a name or a TOML file.")]
Fields = Annotated[Literal["peak", "all"], typer.Option("--fields", help="Which steps' fields are written as VTU.")]
Tissue = Annotated[
    list[str] | None,
    typer.Option("--tissue", help="Another tissue for the scenario; give two or more to compare them in one report."),
]
Wave = Annotated[Path | None, typer.Option("--wave", help="Your own fast model in the wave's place: a Python file.")]
Reference = Annotated[
    Path | None,
    typer.Option("--reference", help="Your own FEA in the FEM's place: a CSV file, or a .dat, .frd or FEBio log."),
]
Model = Annotated[Path | None, typer.Option("--model", help="Switch on the effects of a model file of discover.")]
Effects = Annotated[Path | None, typer.Option("--effects", help="Effects of your own that the model file names.")]
Repeats = Annotated[int, typer.Option("--repeats", min=3, help="Timed repeats of each model.")]

Export = Annotated[
    str | None,
    typer.Option("--export", help="Write the scenario for another code, too: inp (CalculiX, Abaqus), feb (FEBio)."),
]
Refine = Annotated[
    bool,
    typer.Option("--refine", help="Coarser and finer runs too: numerical uncertainty, growth of time."),
]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("run", help=run.__doc__)(run)


def run(
    scenario: Scenario = None,
    trials: Trials = None,
    specimen: Specimen = None,
    tissue: Tissue = None,
    wave: Wave = None,
    reference: Reference = None,
    model: Model = None,
    effects: Effects = None,
    out: Out = None,
    settings: Set = None,
    fields: Fields = "peak",
    repeats: Repeats = 3,
    refine: Refine = False,
    export: Export = None,
    seed: Seed = 0,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Run FEM and wave model side by side, compare them, and write a report.

    With SCENARIO that scenario; with --trials a session, its specimen fitted first; with neither the shipped
    phantom session, the scenario skin-5N and, last, discover on the shipped session gel_pad, in which an effect is
    hidden, each into a folder of its own.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import show_discovery, show_runs
    from benchmark.discovery.discovery_request import discover_shipped
    from benchmark.errors import InputError
    from benchmark.runs import RunOptions, RunRequest, carry_out
    from benchmark.runs.fields import missing_vtk

    missing = missing_vtk() if fields == "all" else None
    if missing is not None:
        raise InputError(f"--fields all: {missing}")
    console = Console(quiet=quiet)
    say_names(console, scenario=scenario, tissues=(*(tissue or ()), specimen), sessions=(trials,))
    request = RunRequest(
        scenario, trials, specimen, parse_settings(settings), out, wave, reference, tuple(tissue or ()), model, effects
    )
    files = () if export is None else tuple(export.split(","))
    options = RunOptions(every_field=fields == "all", repeats=repeats, refine=refine, seed=seed, export=files)
    outcomes = carry_out(request, options, console)
    if scenario is not None or trials is not None:
        return show_runs(outcomes, console, as_json=json)
    found = discover_shipped(out, seed, console)
    code = show_runs(outcomes, console, as_json=json, found=found)
    return code if json else show_discovery(found, console, as_json=False)
