"""`benchmark tissues`: what ships, with sources, and a file to start from."""

from __future__ import annotations

from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json

Name = Annotated[str | None, typer.Argument(help="A shipped tissue or a TOML file, to see its layers; or: new.")]
NewName = Annotated[str | None, typer.Argument(help="With new: the name of the tissue file to write.")]
NEW = "new"


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("tissues", help=tissues.__doc__)(tissues)


def tissues(name: Name = None, new_name: NewName = None, json: Json = False, debug: Debug = False) -> int:
    """List the shipped tissues with their sources, or show the layers of one.

    `tissues new NAME` writes the commented file NAME.toml to start from; it never overwrites one.
    """
    if name == NEW:
        _write_new(new_name, as_json=json)
    elif new_name is not None:
        raise typer.BadParameter(f"{new_name!r} is one word too many; allowed: tissues [NAME] or tissues new NAME")
    elif name is not None:
        _show(name, as_json=json)
    else:
        _list(as_json=json)
    return 0


def _write_new(name: str | None, *, as_json: bool) -> None:
    from benchmark.cli.show import print_json
    from benchmark.files.shipped import write_new_tissue

    if name is None:
        raise typer.BadParameter("the name is missing: tissues new NAME")
    path = write_new_tissue(name)
    if as_json:
        print_json({"schema": 1, "file": str(path)})
    else:
        print(f"{path}\n  run it: python -m benchmark run skin-5N --tissue {path}")


def _show(name: str, *, as_json: bool) -> None:
    from benchmark.cli.show import print_json
    from benchmark.files import load_tissue

    tissue = load_tissue(name)
    if as_json:
        print_json(tissue.to_table())
    else:
        print(tissue.to_toml(), end="")


def _list(*, as_json: bool) -> None:
    from benchmark.cli.show import print_json
    from benchmark.files import load_tissue, shipped_tissues

    found = {entry: load_tissue(entry) for entry in shipped_tissues()}
    if as_json:
        rows = [{"name": key, "layers": each.layer_names, "citation": each.citation} for key, each in found.items()]
        print_json({"schema": 1, "tissues": rows})
    else:
        for key, each in found.items():
            print(f"{key}\n  layers: {', '.join(each.layer_names)}\n  source: {each.citation}")
