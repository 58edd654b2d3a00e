"""`recover`: save what is whole in a cut or damaged trial."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting


def register(app: typer.Typer) -> None:
    """Add the verb."""
    app.command("recover")(recover)


def recover(
    file: Annotated[Path, typer.Argument(help="A trial: cut, damaged, or still named NAME.mcap.part.")],
    out: Annotated[Path, typer.Option(help="The new trial, NEW.mcap; must not exist.")],
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Save what is whole in a cut or damaged trial into a new file; the original is only read.

    Every message keeps its bytes, its times and its place; chunks after a damaged one are kept. Exit 0 where
    something was kept; exit 2 and no file where nothing was.
    """
    with reporting(debug):
        from bench_hw.trial_file.recovery import recover_trial

        recovery = recover_trial(file, out)
        if as_json:
            print_json(recovery.to_dict())
        elif not quiet:
            kept = ", ".join(f"{count} {name}" for name, count in recovery.kept.items())
            print(f"{recovery.out}: kept {kept}")
            print("whole, nothing is lost" if recovery.whole else f"lost: {recovery.lost_bytes} bytes")
            if recovery.reason:
                print(f"found: {recovery.reason}")
