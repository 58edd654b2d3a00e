"""`benchmark tissues`: what ships, with sources."""

from __future__ import annotations

from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json

Name = Annotated[str | None, typer.Argument(help="A shipped tissue or a TOML file, to see its layers.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("tissues", help=tissues.__doc__)(tissues)


def tissues(name: Name = None, json: Json = False, debug: Debug = False) -> int:
    """List the shipped tissues with their sources, or show the layers of one."""
    from benchmark.cli.show import print_json
    from benchmark.files import load_tissue, shipped_tissues

    if name is not None:
        tissue = load_tissue(name)
        if json:
            print_json(tissue.to_table())
        else:
            print(tissue.to_toml(), end="")
        return 0
    found = {entry: load_tissue(entry) for entry in shipped_tissues()}
    if json:
        rows = [{"name": key, "layers": each.layer_names, "citation": each.citation} for key, each in found.items()]
        print_json({"schema": 1, "tissues": rows})
    else:
        for key, each in found.items():
            print(f"{key}\n  layers: {', '.join(each.layer_names)}\n  source: {each.citation}")
    return 0
