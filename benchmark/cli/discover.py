"""`benchmark discover`: where simulation and measurement disagree, which effect is missing, what it closes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Seed, Set, parse_settings, say_names

if TYPE_CHECKING:
    from benchmark.discovery.report.discovery_record import NextExperiment

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

Bench = Annotated[
    str | None,
    typer.Option("--bench", help="Close the loop on this bench: a rig file, or the shipped rig simulated."),
]
BUDGET = 3
"""Experiments of the loop where nobody says how many."""
Budget = Annotated[
    int | None,
    typer.Option("--budget", min=1, max=20, help=f"Most experiments of the loop of --bench; {BUDGET} without it."),
]
Refit = Annotated[
    str | None,
    typer.Option(
        "--refit",
        help="Put effects into the FEM and the wave model, refit them there, and predict unseen conditions and tools: "
        "found (those accepted), or SLUG,SLUG of your choice.",
    ),
]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("discover", help=discover.__doc__)(discover)


def discover(
    paths: Paths,
    model: Model = "wave",
    effects: Effects = None,
    specimen: Specimen = None,
    bench: Bench = None,
    budget: Budget = None,
    refit: Refit = None,
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
    With --bench the experiment that best separates the rivals is done there, its trials added to a copy of the session
    and decided again, until one name stands or the budget ends. Exit code 0 whatever is found; where the bench ends the
    loop with a fault, the answer so far is written, and the exit code is the fault's.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import show_discovery
    from benchmark.discovery.discovery_request import DiscoverRequest, carry_out

    console = Console(quiet=quiet)
    say_names(console, tissues=(specimen,), sessions=paths)
    _check_together(paths, bench, budget, refit)
    _check_picked(refit, effects)
    most = BUDGET if budget is None else budget
    request = DiscoverRequest(
        paths, model, effects, specimen, parse_settings(settings), out, seed, bench, most, _asked, refit
    )
    outcome = carry_out(request, console)
    code = show_discovery(outcome, console, as_json=json)
    if outcome.stopped is not None:
        raise type(outcome.stopped)(
            f"{outcome.stopped}; the answer so far is in {outcome.folder}, what the bench recorded in its session/"
        )
    return code


def _check_together(paths: Sequence[Path], bench: str | None, budget: int | None, refit: str | None) -> None:
    """Refuse options that would change nothing: `--budget` without a bench, a session's beside finished runs."""
    from benchmark.discovery.from_run import is_run
    from benchmark.errors import InputError

    if (bench is not None or refit is not None) and any(is_run(path) for path in paths):
        raise InputError("--bench and --refit belong to a session: a finished run has no trials to add or refit to")
    if budget is not None and bench is None:
        raise InputError("--budget is the most experiments of a bench's loop: give --bench with it")


def _check_picked(refit: str | None, own: Path | None) -> None:
    """Refuse a slug that no session can have, before the hours of a discovery.

    Those of a set-up, `setup.KEY`, depend on the session's layers and are looked up once these are known.
    """
    from benchmark.errors import InputError
    from benchmark.files.schema import nearest
    from benchmark.physics import SLUGS, load_effects

    if refit is None or refit == "found":
        return
    picked = [slug.strip() for slug in refit.split(",") if slug.strip()]
    if not picked:
        raise InputError(f"--refit {refit!r} names no effect; allowed: found, or SLUG,SLUG of your choice")
    known = {*SLUGS, *(() if own is None else (effect.slug for effect in load_effects(own)))}
    for slug in picked:
        if slug not in known and not slug.startswith("setup."):
            raise InputError(f"--refit {refit}: {slug!r} is no effect; {nearest(slug, ('found', *sorted(known)))}")


def _asked(proposal: NextExperiment, setup: Mapping[str, Any]) -> bool:
    """Show what must be done by hand first; whether it was done. Nothing moves without a person's word."""
    import sys

    if not sys.stdin.isatty():
        return False
    print(f"{proposal.words} ({', '.join(f'{key} = {value}' for key, value in setup.items())})", file=sys.stderr)
    return typer.confirm("Done, and the bench is free to move?", err=True)
