"""`benchmark sweep`: one scenario at many points of its parameters."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Seed, Set, parse_settings, say_names

Scenario = Annotated[str, typer.Argument(help="A shipped scenario's name or a TOML file.")]
Vary = Annotated[
    list[str],
    typer.Option(
        "--vary",
        metavar="KEY=VALUES",
        help='What varies: a list, tool.radius="2 mm,5 mm", or a range, dermis.youngs_modulus="50 kPa:500 kPa:10:log".',
    ),
]
Tissue = Annotated[str | None, typer.Option("--tissue", help="Another tissue for the scenario: a name or a TOML file.")]
Sample = Annotated[
    Literal["lhs", "sobol"] | None,
    typer.Option("--sample", help="Draw points: a Latin hypercube or a Sobol sequence; without, every combination."),
]
Points = Annotated[int | None, typer.Option("--points", min=1, help="Points of a sample.")]
Sensitivity = Annotated[bool, typer.Option("--sensitivity", help="Sobol indices of results, by a design of its own.")]
Workers = Annotated[int | None, typer.Option("--workers", min=1, help="Processes here; one a core by default.")]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="A Dask cluster, as tcp://host:8786.")
]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("sweep", help=sweep.__doc__)(sweep)


def sweep(
    scenario: Scenario,
    vary: Vary,
    tissue: Tissue = None,
    sample: Sample = None,
    points: Points = None,
    sensitivity: Sensitivity = False,
    workers: Workers = None,
    scheduler: Scheduler = None,
    out: Out = None,
    settings: Set = None,
    seed: Seed = 0,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Run FEM and wave model at many points of a scenario's parameters.

    Writes points.parquet as points finish, then report.html. The same command again finishes what is missing.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json
    from benchmark.errors import SolverError
    from benchmark.sweeps.sweep_run import SweepRequest, run_sweep

    console = Console(quiet=quiet)
    say_names(console, scenario=scenario, tissues=(tissue,))
    request = SweepRequest(
        scenario=scenario,
        vary=tuple(vary),
        settings=parse_settings(settings) | ({} if tissue is None else {"tissue": tissue}),
        sample=sample,
        points=points,
        sensitivity=sensitivity,
        out=out,
        seed=seed,
        workers=workers,
        scheduler=scheduler,
    )
    try:
        outcome = run_sweep(request, console)
    except KeyboardInterrupt:
        console.say("stopped; finished points are kept, the same command goes on with the others")
        raise
    if json:
        print_json({**outcome.document, "out": str(outcome.folder)})
    else:
        print(f"{outcome.document['name']}: {outcome.headline}\n  report: {outcome.folder / 'report.html'}")
    if not outcome.any_ok:
        raise SolverError(f"no point of the sweep has results; the reasons are in {outcome.folder / 'points.parquet'}")
    return 0
