"""`benchmark reference`: a table to fill in with your own FEA."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json, Set, parse_settings

Word = Annotated[str, typer.Argument(help="new.")]
Name = Annotated[str, typer.Argument(help="A shipped scenario or a TOML file.")]
File = Annotated[Path | None, typer.Option("--out", metavar="FILE", help="The table; by default SCENARIO-fea.csv.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("reference", help=reference.__doc__)(reference)


def reference(
    word: Word, name: Name, settings: Set = None, out: File = None, json: Json = False, debug: Debug = False
) -> int:
    """`reference new SCENARIO` writes the table for your own FEA of it, one row a step and layer, `fem_mm` left empty.

    It never overwrites one. `run SCENARIO --reference FILE` then puts the filled table in the FEM's place.
    """
    if word != "new":
        raise typer.BadParameter(f"{word!r} is not known; allowed: reference new SCENARIO")
    from benchmark.cli.show import print_json
    from benchmark.files import load_scenario
    from benchmark.models.own_models import write_template

    scenario = load_scenario(name, parse_settings(settings))
    path = out if out is not None else Path(f"{Path(name).stem}-fea.csv")
    write_template(path, scenario)
    if json:
        print_json({"schema": 1, "file": str(path)})
    else:
        print(f"{path}\n  fill in fem_mm, then, with the same --set: python -m benchmark run {name} --reference {path}")
    return 0
