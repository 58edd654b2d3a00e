"""`benchmark check`: whether accuracy or speed got worse."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Seed

if TYPE_CHECKING:
    from benchmark.cli.console import Console
    from benchmark.gate.accepting import Accepted
    from benchmark.gate.checking import CheckOutcome

Baseline = Annotated[
    Path | None,
    typer.Option("--baseline", help="The baseline to compare with; by default tissuebench-baseline.json, here."),
]
Against = Annotated[
    str | None,
    typer.Option("--against", metavar="REV", help="Time this version beside another revision, in the same minutes."),
]
Accept = Annotated[bool, typer.Option("--accept", help="Measure, print old -> new, and write the baseline.")]
Gate = Annotated[Path | None, typer.Option("--gate", help="What is gated: a TOML file; by default the shipped one.")]
History = Annotated[
    Path | None,
    typer.Option("--history", help="File (or folder) that each check is added to; by default beside the baseline."),
]

Junit = Annotated[Path | None, typer.Option("--junit", metavar="FILE", help="Write the verdict as JUnit XML, too.")]
Markdown = Annotated[Path | None, typer.Option("--markdown", metavar="FILE", help="Write it as Markdown, too.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("check", help=check.__doc__)(check)


def check(
    baseline: Baseline = None,
    against: Against = None,
    accept: Accept = False,
    gate: Gate = None,
    history: History = None,
    junit: Junit = None,
    markdown: Markdown = None,
    out: Out = None,
    seed: Seed = 0,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Compare accuracy and time with a baseline or another revision; exit 1 where one got worse.

    The first baseline is made with --accept; without one the exit code is 3.
    """
    from benchmark.cli.console import Console
    from benchmark.gate import accepting, checking
    from benchmark.gate.plan import CheckRequest

    console = Console(quiet=quiet)
    request = CheckRequest(baseline, against, gate, history, out, seed, junit, markdown)
    if accept:
        _refuse_reports({"--junit": junit, "--markdown": markdown, "--out": out})
        return _show_accepted(accepting.accept(request, console), console, as_json=json)
    return _show_check(checking.check(request, console), console, as_json=json)


def _refuse_reports(given: dict[str, Path | None]) -> None:
    """Refuse files that are written of a check alone; raises InputError."""
    from benchmark.errors import InputError

    asked = [option for option, path in given.items() if path is not None]
    if asked:
        raise InputError(f"--accept makes a baseline and no report: leave out {', '.join(asked)}, or check afterwards")


def _show_accepted(accepted: Accepted, console: Console, *, as_json: bool) -> int:
    """Print what a new baseline changes."""
    from benchmark.cli.show import print_json

    if as_json:
        print_json(accepted.to_dict())
    else:
        for warning in accepted.warnings:
            console.say(f"  warning: {warning}")
        for step in accepted.steps:
            print(step.words())
        if accepted.unseen is not None:
            print(accepted.unseen)
        print(f"baseline: {accepted.path}")
    return 0


def _show_check(outcome: CheckOutcome, console: Console, *, as_json: bool) -> int:
    """Print the verdict and return the exit code.

    Raises
    ------
    GateError
        Something got worse.
    """
    from benchmark.cli.show import print_json
    from benchmark.errors import GateError

    verdict = outcome.verdict
    for warning in verdict.warnings:
        console.say(f"  warning: {warning}")
    if as_json:
        print_json({**outcome.document, "out": str(outcome.folder)})
    else:
        for line in (*verdict.summary(), f"{verdict.headline()}\n  report: {outcome.report}"):
            print(line)
    if not verdict.passed:
        raise GateError(f"{verdict.headline()} {'; '.join(verdict.failures())}. Report: {outcome.report}")
    return 0
