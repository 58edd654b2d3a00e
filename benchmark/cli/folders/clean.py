"""`benchmark clean`: away with what runs that were killed left behind."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json

Folder = Annotated[Path, typer.Argument(help="Where to look, there and below.")]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Say what is there and remove nothing.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("clean", help=clean.__doc__)(clean)


def clean(folder: Folder = Path(), dry_run: DryRun = False, json: Json = False, debug: Debug = False) -> int:
    """Remove what killed runs left: half-written files and folders, locks, and the steps kept to go on from.

    Results, recordings, and whatever this program did not write stay. A run that is at work is left alone. After this
    a stopped run begins anew instead of going on.
    """
    from benchmark.cli.show import print_json
    from benchmark.errors import InputError
    from benchmark.litter import cut_recordings, find_litter, remove

    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such folder to clean")
    found = list(find_litter(folder))
    gone = [] if dry_run else [litter for litter in found if remove(litter)]
    recordings = cut_recordings(folder)
    if json:
        rows = [{"path": str(each.path), "what": each.what, "bytes": each.size} for each in found]
        removed = [str(each.path) for each in gone]
        print_json({"schema": 1, "found": rows, "removed": removed, "recordings": [str(path) for path in recordings]})
        return 0
    for each in found:
        word = "would go" if dry_run else "removed" if each in gone else "stays, it holds other files"
        print(f"{each.path}: {each.what}, {each.size / 1e6:.1f} MB, {word}")
    for path in recordings:
        print(f"{path}: a recording that was cut off, stays; python -m bench_hw recover {path} --out NEW.mcap")
    if not found and not recordings:
        print(f"{folder}: nothing to clean")
    return 0
