"""`benchmark scenarios`: what ships."""

from __future__ import annotations

from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json, Set, parse_settings

Name = Annotated[str | None, typer.Argument(help="A shipped scenario or a TOML file, to see it resolved.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("scenarios", help=scenarios.__doc__)(scenarios)


def scenarios(name: Name = None, settings: Set = None, json: Json = False, debug: Debug = False) -> int:
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
