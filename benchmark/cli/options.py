"""Options that every verb shares, declared once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from benchmark.cli.console import Console

Out = Annotated[Path | None, typer.Option("--out", help="Folder of the result; by default results/NAME-DATE-TIME.")]
Json = Annotated[
    bool,
    typer.Option("--json", help="Print one JSON object on stdout and nothing else; without a result stdout is empty."),
]
Seed = Annotated[int, typer.Option("--seed", min=0, help="Seed of every random draw.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress and no remarks.")]
Debug = Annotated[bool, typer.Option("--debug", help="Show a traceback with an error.")]
Set = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help='Change one value, as in --set dermis.youngs_modulus="120 kPa".'),
]


def say_names(
    console: Console,
    *,
    tissues: Iterable[str | None] = (),
    scenario: str | None = None,
    sessions: Iterable[Path | None] = (),
) -> None:
    """Say which one is taken where something that ships and a file here have the same name."""
    from benchmark.files.shipped import said_of_name

    asked = [("scenario", scenario), *(("tissue", each) for each in tissues), *(("session", each) for each in sessions)]
    for what, name in asked:
        if name is not None and (said := said_of_name(name, what)):
            console.say(said)


def parse_settings(settings: Sequence[str] | None) -> dict[str, str]:
    """Split `KEY=VALUE` items; a later one wins.

    Raises
    ------
    InputError
        An item has no `=` or no key.
    """
    from benchmark.errors import InputError

    pairs: dict[str, str] = {}
    for item in settings or []:
        key, equals, value = item.partition("=")
        if not equals or not key.strip():
            raise InputError(f'--set {item!r} is not of the form KEY=VALUE, as in --set load.peak="2 N"')
        pairs[key.strip()] = value.strip()
    return pairs
