"""`benchmark press`: a tissue to press in the browser, the finite elements' answer beside the wave's."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from benchmark.cli.options import Debug, Json, Quiet, Set, parse_settings

What = Annotated[
    str | None,
    typer.Argument(help="A scenario or tissue (name or TOML file), a model file, or a result of run or discover."),
]
Save = Annotated[Path, typer.Option("--save", help="The page as one file that works offline, to open or to mail.")]
Tissue = Annotated[list[str] | None, typer.Option("--tissue", help="A further tissue to choose on the page.")]
Tool = Annotated[
    list[str] | None, typer.Option("--tool", help='A further tool to choose on the page, by its radius: "2 mm".')
]
Model = Annotated[Path | None, typer.Option("--model", help="Before and after the effects of a model file.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("press", help=press.__doc__)(press)


def press(
    save: Save,
    what: What = None,
    tissue: Tissue = None,
    tool: Tool = None,
    model: Model = None,
    settings: Set = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Press a tissue by hand: the wave model in a page, with the finite elements' answer to the same press.

    Without WHAT the page offers several shipped tissues and tools.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json
    from benchmark.press.press_page import render_press_page
    from benchmark.press.press_request import PressRequest, document, specimens
    from benchmark.runs.output.destination import check_file
    from reports import write_text

    console = Console(quiet=quiet)
    check_file(save, "--save")
    request = PressRequest(what, tuple(tissue or ()), tuple(tool or ()), parse_settings(settings), model)
    found = specimens(request, console)
    page = render_press_page(document(found))
    write_text(save, page)
    if json:
        presses = [{"tissue": one.scenario.tissue.name, "effects": list(one.effects)} for one in found]
        print_json({"schema": 1, "file": str(save), "bytes": len(page.encode()), "presses": presses})
    else:
        print(f"{save}: {len(found)} to press, {len(page.encode()) / 1e6:.1f} MB; open it in a browser")
    return 0
