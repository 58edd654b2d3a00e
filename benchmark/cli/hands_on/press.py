"""`benchmark press`: a tissue to press in the browser, the finite elements' answer beside the wave's."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from benchmark.cli.options import Debug, Json, Quiet, Set, parse_settings

if TYPE_CHECKING:
    from benchmark.press.pressed_specimen import PressedSpecimen

What = Annotated[
    str | None,
    typer.Argument(help="A scenario or tissue (name or TOML file), a model file, or a result of run or discover."),
]
Save = Annotated[
    Path | None,
    typer.Option(
        "--save", help="Write the page as one file that works offline, to open or to mail, and serve nothing."
    ),
]
Port = Annotated[int, typer.Option("--port", min=0, max=65535, help="Of this machine alone; 0 takes a free one.")]
Browser = Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page.")]
Tissue = Annotated[list[str] | None, typer.Option("--tissue", help="A further tissue to choose on the page.")]
Tool = Annotated[
    list[str] | None, typer.Option("--tool", help='A further tool to choose on the page, by its radius: "2 mm".')
]
Model = Annotated[Path | None, typer.Option("--model", help="Before and after the effects of a model file.")]


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("press", help=press.__doc__)(press)


def press(
    what: What = None,
    save: Save = None,
    tissue: Tissue = None,
    tool: Tool = None,
    model: Model = None,
    settings: Set = None,
    port: Port = 0,
    browser: Browser = True,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Press a tissue by hand: the wave model in a page, with the finite elements' answer to the same press.

    Without WHAT the page offers several shipped tissues and tools. Without --save it is served to this machine alone,
    where the finite elements can be asked for a press as it was made, until Ctrl-C.
    """
    from benchmark.cli.console import Console
    from benchmark.press.press_request import PressRequest, specimens
    from benchmark.runs.output.destination import check_file

    console = Console(quiet=quiet)
    check_file(save, "--save")
    request = PressRequest(what, tuple(tissue or ()), tuple(tool or ()), parse_settings(settings), model)
    found = specimens(request, console)
    if save is None:
        _serve(found, port, open_page=browser, as_json=json)
    else:
        _write(found, save, as_json=json)
    return 0


def _write(found: Sequence[PressedSpecimen], save: Path, *, as_json: bool) -> None:
    from benchmark.cli.show import print_json
    from benchmark.press.press_page import render_press_page
    from benchmark.press.press_request import document
    from reports import write_text

    page = render_press_page(document(found))
    write_text(save, page)
    if as_json:
        presses = [{"tissue": one.scenario.tissue.name, "effects": list(one.effects)} for one in found]
        print_json({"schema": 1, "file": str(save), "bytes": len(page.encode()), "presses": presses})
    else:
        print(f"{save}: {len(found)} to press, {len(page.encode()) / 1e6:.1f} MB; open it in a browser")


def _serve(found: Sequence[PressedSpecimen], port: int, *, open_page: bool, as_json: bool) -> None:
    import json
    import webbrowser

    from benchmark.press.fem_on_demand import FemOnDemand
    from benchmark.press.press_page import render_press_page
    from benchmark.press.press_request import document
    from benchmark.press.press_server import serve

    def say(address: str) -> None:
        print(json.dumps({"schema": 1, "address": address}) if as_json else f"{address}  (Ctrl-C ends it)", flush=True)
        if open_page:
            webbrowser.open(address)

    serve(render_press_page(document(found), served=True), FemOnDemand(found).answer, port, say)
