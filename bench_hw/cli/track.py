"""`track`: from pictures to marker tracks."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting

if TYPE_CHECKING:
    from bench_hw.vision import Progress
    from bench_hw.vision.tracking.pipeline import TrackOutcome

_PLAIN_STEP = 500


def register(app: typer.Typer) -> None:
    """Add the verb."""
    app.command("track")(track)


def track(
    source: Annotated[str, typer.Argument(help="A trial (.mcap), a video, a folder or pattern of pictures.")],
    camera: Annotated[Path, typer.Option(help="The camera.toml of `calibrate`.")],
    out: Annotated[Path, typer.Option(help="The table to write, for instance markers.csv.")],
    method: Annotated[str, typer.Option(help="subpixel, or paper: the article's chain.")] = "subpixel",
    grid: Annotated[str, typer.Option(help="ROWSxCOLUMNS as in the picture; 18 markers without it.")] = "",
    fps: Annotated[float | None, typer.Option(help="Pictures per second of a video or folder.")] = None,
    pixels: Annotated[bool, typer.Option("--pixels", help="Undistorted pixels instead of mm: x_px, y_px.")] = False,
    sinking: Annotated[
        Path | None, typer.Option(help="CSV time_s, [marker,] sunk_mm: correct the perspective with it.")
    ] = None,
    recentre: Annotated[
        bool, typer.Option("--recentre", help="Origin at the grid's middle in the first picture.")
    ] = False,
    overlay: Annotated[Path | None, typer.Option(help="Video (.avi) with what was found drawn in.")] = None,
    still: Annotated[Path | None, typer.Option(help="Picture (.png) of the farthest motion, drawn in.")] = None,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Track the markers of a trial or video: time_s, marker, x_mm, y_mm, confidence, a row per frame and marker.

    Markers are numbered row by row from 0 in the first picture that shows the whole grid; empty cells where one
    is not seen. x to the right, y down in the picture, from the origin in the camera file. Exit 2 and no table for
    a wrong camera file or size, another number of markers, or a jump of half the spacing or more.
    """
    with reporting(debug):
        from bench_hw.vision import silence_opencv
        from bench_hw.vision.markers.grid import parse_layout
        from bench_hw.vision.tracking.film import TrackOrder
        from bench_hw.vision.tracking.film import track as run

        silence_opencv()
        layout = parse_layout(grid) if grid else None
        order = TrackOrder(source, camera, out, method, layout, fps, pixels, sinking, recentre, overlay, still)
        with _progress(quiet or as_json) as progress:
            outcome = run(order, progress)
        for warning in outcome.warnings:
            print(f"warning: {warning}", file=sys.stderr)
        if as_json:
            print_json(outcome.to_dict())
        elif not quiet:
            print(_text(outcome))


def _text(outcome: TrackOutcome) -> str:
    tally = outcome.tally
    missing = 100.0 * float(tally.missing.mean()) / max(tally.frames, 1)
    return (
        f"{outcome.out}: {tally.frames} frames, {outcome.grid.layout.count} markers ({outcome.grid.layout}), "
        f"{missing:.2g} % missing, method {outcome.method}" + (", synthetic" if outcome.synthetic else "")
    )


@contextmanager
def _progress(silent: bool) -> Iterator[Progress | None]:
    """Give what shows progress: nothing, a bar on a terminal, or a line now and then."""
    if silent:
        yield None
    elif not sys.stderr.isatty():
        yield _say
    else:
        from rich.console import Console
        from rich.progress import Progress as Bar

        with Bar(console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task("tracking", total=None)
            yield lambda done, total: bar.update(task, completed=done, total=total)


def _say(done: int, total: int | None) -> None:
    if done % _PLAIN_STEP == 0:
        print(f"{done} of {total or '?'} pictures", file=sys.stderr, flush=True)
