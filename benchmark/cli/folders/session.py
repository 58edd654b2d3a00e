"""`benchmark session`: a file to start from for a folder of trials."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from benchmark.cli.options import Debug, Json

What = Annotated[Literal["new"], typer.Argument(help="new: propose a session.toml.")]
Folder = Annotated[Path, typer.Argument(help="A folder of trials: CSV, or any instrument's files.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("session", help=session.__doc__)(session)


def session(what: What, folder: Folder, json: Json = False, debug: Debug = False) -> int:
    """Look at a folder's files and write the session.toml and specimen.toml they suggest.

    Conditions come from speeds, depths and holds, tool and thickness from headers and the first touch. What a person
    must say is marked SAY in the files. Files that are there are never replaced.
    """
    from benchmark.cli.show import print_json
    from benchmark.files.sessions.proposal import propose
    from reports.atomic import write_text

    found = propose(folder)
    written = [folder / name for name in found.texts]
    for path, text in zip(written, found.texts.values(), strict=True):
        write_text(path, text)
    if json:
        print_json({"schema": 1, "files": [str(path) for path in written], "to_say": list(found.to_say)})
    else:
        print("\n".join(map(str, written)))
        print(f"  look at it, and say: {', '.join(found.to_say)} (marked SAY)")
        print(f"  then: python -m benchmark run --trials {folder}")
    return 0
