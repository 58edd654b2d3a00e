"""`benchmark press` and `benchmark assess`: a tissue to press in the browser, and how it was pressed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Set, parse_settings

if TYPE_CHECKING:
    from benchmark.press.live_capture import LiveCapture
    from benchmark.press.pressed_specimen import PressedSpecimen

What = Annotated[
    str | None,
    typer.Argument(
        help="A scenario or tissue (name or TOML file), a model file, a result of run or discover, or a session folder."
    ),
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
Live = Annotated[
    Path | None,
    typer.Option("--live", help="Show a running capture beside: its session's folder, or its NAME.mcap.part."),
]

Records = Annotated[
    list[Path], typer.Argument(help="Records of press (CSV), or folders of them: two folders are compared as groups.")
]


def register(app: typer.Typer) -> None:
    """Add both verbs to the command line."""
    app.command("press", help=press.__doc__)(press)
    app.command("assess", help=assess.__doc__)(assess)


def press(
    what: What = None,
    save: Save = None,
    tissue: Tissue = None,
    tool: Tool = None,
    model: Model = None,
    live: Live = None,
    settings: Set = None,
    port: Port = 0,
    browser: Browser = True,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Press a tissue by hand: the wave model in a page, with the finite elements' answer to the same press.

    Without WHAT the page offers several shipped tissues and tools. Without --save it is served to this machine alone,
    where the finite elements can be asked for a press as it was made, until Ctrl-C. With --live it shows what a running
    capture records: camera with markers, force and depth, and the models under the bench's own press.
    """
    from benchmark.cli.console import Console
    from benchmark.press.press_page import SIGN, PressRequest, specimens
    from benchmark.runs.output.destination import check_file

    console = Console(quiet=quiet)
    check_file(save, "--save", SIGN, "a page of press")
    watched = None if live is None else _watched(live, save)
    what = "skin-5N" if what is None and live is not None else what
    request = PressRequest(what, tuple(tissue or ()), tuple(tool or ()), parse_settings(settings), model)
    found = specimens(request, console)
    if save is None:
        _serve(found, port, watched, open_page=browser, as_json=json)
    else:
        _write(found, save, as_json=json)
    return 0


def _write(found: Sequence[PressedSpecimen], save: Path, *, as_json: bool) -> None:
    from benchmark.cli.show import print_json
    from benchmark.press.press_page import document, render_press_page
    from reports import write_text

    page = render_press_page(document(found))
    write_text(save, page)
    if as_json:
        presses = [{"tissue": one.scenario.tissue.name, "effects": list(one.effects)} for one in found]
        print_json({"schema": 1, "file": str(save), "bytes": len(page.encode()), "presses": presses})
    else:
        print(f"{save}: {len(found)} to press, {len(page.encode()) / 1e6:.1f} MB; open it in a browser")


def _watched(live: Path, save: Path | None) -> LiveCapture:
    from bench_hw.errors import BenchError
    from benchmark.errors import InputError
    from benchmark.press.live_capture import LiveCapture

    if save is not None:
        raise InputError("--live shows a capture while it runs, and --save a page that speaks with nobody: give one")
    try:
        return LiveCapture(live)
    except BenchError as error:
        raise InputError(f"--live {error}") from error


def _serve(
    found: Sequence[PressedSpecimen], port: int, watched: LiveCapture | None, *, open_page: bool, as_json: bool
) -> None:
    import json
    import webbrowser

    from benchmark.press.press_page import document, render_press_page
    from benchmark.press.press_server import FemOnDemand, serve

    def say(address: str) -> None:
        print(json.dumps({"schema": 1, "address": address}) if as_json else f"{address}  (Ctrl-C ends it)", flush=True)
        if open_page:
            webbrowser.open(address)

    page = render_press_page(document(found), served=True, live=watched is not None)
    if watched is None:
        serve(page, FemOnDemand(found).answer, port, say)
    else:
        from benchmark.press.live_capture import LiveLine, tell

        serve(page, FemOnDemand(found).answer, port, say, ("live", LiveLine, lambda served: tell(served, watched)))


def assess(
    records: Records,
    out: Out = None,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Measure recorded attempts: time, path, smoothness, accuracy, tremor.

    Two folders are compared as groups, such as expert and novice, measure by measure, with power.
    """
    from benchmark.assessment.skill_comparison import assess as assessed
    from benchmark.assessment.skill_comparison import summary, write_assessment
    from benchmark.cli.show import print_json
    from benchmark.runs.output.destination import claimed, destination

    with claimed(out, "assess"):
        destination(out, "", records)
        found = assessed(records)
        folder = write_assessment(found, out)
    if json:
        print_json({**summary(found), "folder": str(folder)})
    else:
        print(f"{found.headline}\n  report: {folder / 'report.html'}")
    return 0
