"""`benchmark tissues`, `scenarios`, `session` and `reference`: what ships, with sources, and files to start from."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated, Literal

import typer

from benchmark.cli.options import Debug, Json, Quiet, Set, parse_settings

Name = Annotated[str | None, typer.Argument(help="A shipped tissue or a TOML file, to see its layers; or: new.")]
NewName = Annotated[str | None, typer.Argument(help="With new: the name of the tissue file to write.")]
ScenarioName = Annotated[str | None, typer.Argument(help="A shipped scenario or a TOML file, to see it resolved.")]
NEW = "new"
What = Annotated[Literal["new"], typer.Argument(help="new: propose a session.toml.")]
Word = Annotated[str, typer.Argument(metavar="new", help="The word new.")]
Shown = Annotated[str, typer.Argument(help="A shipped scenario or a TOML file.")]
Table = Annotated[Path | None, typer.Option("--out", metavar="FILE", help="The table; by default SCENARIO-fea.csv.")]
Folder = Annotated[Path, typer.Argument(help="A folder of trials: CSV, or any instrument's files.")]


def register(app: typer.Typer) -> None:
    """Add the verbs to the command line."""
    app.command("tissues", help=tissues.__doc__)(tissues)
    app.command("scenarios", help=scenarios.__doc__)(scenarios)
    app.command("session", help=session.__doc__)(session)
    app.command("reference", help=reference.__doc__)(reference)


def tissues(
    name: Name = None, new_name: NewName = None, json: Json = False, quiet: Quiet = False, debug: Debug = False
) -> int:
    """List the shipped tissues with their sources, or show the layers of one.

    `tissues new NAME` writes the commented file NAME.toml to start from; it never overwrites one.
    """
    if name == NEW:
        _write_new(new_name, as_json=json, quiet=quiet)
    elif new_name is not None:
        raise typer.BadParameter(f"{new_name!r} is one word too many; allowed: tissues [NAME] or tissues new NAME")
    elif name is not None:
        _show(name, as_json=json)
    else:
        _list(as_json=json)
    return 0


def _write_new(name: str | None, *, as_json: bool, quiet: bool) -> None:
    from benchmark.cli.show import print_json
    from benchmark.files.shipped import write_new_tissue

    if name is None:
        raise typer.BadParameter("the name is missing: tissues new NAME")
    path = write_new_tissue(name)
    if as_json:
        print_json({"schema": 1, "file": str(path)})
    else:
        _print(path, f"  run it: python -m benchmark run skin-5N --tissue {_typed(path)}", quiet=quiet)


def _print(path: Path, remark: str, *, quiet: bool) -> None:
    """Print a file that was written, and what to do with it."""
    print(path if quiet else f"{path}\n{remark}")


def _typed(path: Path | str) -> str:
    """A path as it is typed in a shell."""
    return shlex.quote(str(path))


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


def scenarios(
    name: ScenarioName = None, settings: Set = None, json: Json = False, quiet: Quiet = False, debug: Debug = False
) -> int:
    """List the shipped scenarios, or show one fully resolved."""
    from benchmark.cli.show import print_json
    from benchmark.files import load_scenario, shipped_scenarios

    if name is not None:
        scenario = load_scenario(name, parse_settings(settings))
        if json:
            print_json(scenario.to_table())
        else:
            print(scenario.to_toml(), end="")
        return 0
    found = {entry: load_scenario(entry) for entry in shipped_scenarios()}
    rows = [
        {"name": key, "tissue": each.tissue.name, "contact": each.tool.contact, "support": each.support.kind}
        for key, each in found.items()
    ]
    if json:
        print_json({"schema": 1, "scenarios": rows})
    else:
        for row in rows:
            print(f"{row['name']}: {row['tissue']}, {row['contact']}, {row['support']}")
    return 0


def session(
    what: What,
    folder: Folder,
    settings: Set = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Look at a folder's files and write the session.toml and specimen.toml they suggest.

    Conditions come from speeds, depths and holds, tool and thickness from headers and the first touch. What a person
    must say is marked SAY in the files. Files that are there are never replaced. `--set import.force="Weight:g"` tells
    of columns that have names of their own.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json
    from benchmark.files.sessions.proposal import propose, write_proposal

    found = propose(folder, parse_settings(settings))
    written = write_proposal(folder, found)
    for warning in found.warnings:
        Console(quiet=quiet).say(f"  warning: {warning}")
    if json:
        said = {"to_say": list(found.to_say), "warnings": list(found.warnings)}
        print_json({"schema": 1, "files": [str(path) for path in written], **said})
    else:
        print("\n".join(map(str, written)))
        if not quiet:
            print(f"  look at it, and say: {', '.join(found.to_say)} (marked SAY)")
            print(f"  then: python -m benchmark run --trials {_typed(folder)}")
    return 0


def reference(
    word: Word,
    name: Shown,
    settings: Set = None,
    out: Table = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
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
        again = f"python -m benchmark run {_typed(name)} --reference {_typed(path)}"
        _print(path, f"  fill in fem_mm, then, with the same --set: {again}", quiet=quiet)
    return 0
