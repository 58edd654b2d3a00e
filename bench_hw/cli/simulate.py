"""`simulate`: devices without hardware, as endpoints on loopback, and whole sessions from them. All synthetic."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting
from bench_hw.errors import InputError

Seed = Annotated[int, typer.Option(help="Of all noise and chance.", min=0)]
Duration = Annotated[
    float | None, typer.Option(help="End after this time, s; without it, on SIGTERM or Ctrl-C.", min=0.0, max=1e7)
]
USUAL_FRAMES = 30
"""Pictures that are written where nobody says how many."""
Loss = Annotated[float, typer.Option(help="Chance that a record or frame is lost.", min=0.0, max=1.0)]
Drop = Annotated[str, typer.Option(help="Positions in the stream, from 1, that are lost: 200-202,500.")]


def register(app: typer.Typer) -> None:
    """Add the verb and its three devices."""
    verb = typer.Typer(no_args_is_help=True, help="Simulated devices and sessions; what they give is synthetic.")
    verb.command("netft")(netft)
    verb.command("camera")(camera)
    verb.command("session")(session)
    app.add_typer(verb, name="simulate")


def netft(
    http_port: Annotated[
        int, typer.Option(help="Port of its web pages; 0 lets the system choose.", min=0, max=65_535)
    ] = 0,
    rdt_port: Annotated[
        int, typer.Option(help="UDP port of its stream; 0 lets the system choose.", min=0, max=65_535)
    ] = 0,
    rate_hz: Annotated[int, typer.Option(help="Records per second at power-on.", min=1, max=7000)] = 7000,
    loss: Loss = 0.0,
    drop: Drop = "",
    duplicate: Annotated[str, typer.Option(help="Positions that come twice.")] = "",
    reorder: Annotated[str, typer.Option(help="Positions that come after the one that follows.")] = "",
    first_sequence: Annotated[int, typer.Option(help="Number of a stream's first record.", min=0)] = 1,
    serial: Annotated[str, typer.Option(help="Serial number of its calibration.")] = "FT00000",
    peak_n: Annotated[float, typer.Option(help="Peak of its slowly swinging press force, N.")] = 2.0,
    seed: Seed = 0,
    duration_s: Duration = None,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Run a Net F/T box on 127.0.0.1 until the time is over or SIGTERM; then say what was sent and dropped."""
    with reporting(debug):
        import numpy as np

        from bench_hw.clock import MonotonicClock
        from bench_hw.devices.rdt import rate_of
        from bench_hw.simulated.netft_box import BoxSettings, NetFTBox
        from bench_hw.simulated.rdt_stream import StreamFaults, parse_positions
        from bench_hw.simulated.specimen import swinging

        faults = StreamFaults(loss, parse_positions(drop), parse_positions(duplicate), parse_positions(reorder))
        settings = BoxSettings(serial, rate=rate_of(rate_hz), first_sequence=first_sequence, faults=faults)
        rng = np.random.default_rng(seed)
        with NetFTBox(swinging(peak_n), MonotonicClock(), settings, rng, rdt_port=rdt_port, http_port=http_port) as box:
            _say(f"Net F/T box: http://{box.host}:{box.http_port}/netftapi2.xml, RDT on UDP {box.rdt_port}", quiet)
            _serve(duration_s)
        _counted(box.sent, box.dropped, "records", as_json=as_json, quiet=quiet)


def camera(
    port: Annotated[int, typer.Option(help="HTTP port; 0 lets the system choose.", min=0, max=65_535)] = 0,
    rate_hz: Annotated[float, typer.Option(help="Frames per second.", min=0.1, max=1000.0)] = 30.0,
    size: Annotated[str, typer.Option(help="Width x height, pixels.")] = "640x480",
    noise: Annotated[float, typer.Option(help="Standard deviation of a grey level.", min=0.0)] = 3.0,
    blur: Annotated[float, typer.Option(help="Standard deviation of the blur, pixels.", min=0.0)] = 0.8,
    jitter_s: Annotated[float, typer.Option(help="Standard deviation of a frame's instant, s.", min=0.0)] = 0.0,
    loss: Loss = 0.0,
    drop: Drop = "",
    freeze: Annotated[str, typer.Option(help="Frames that repeat the one before.")] = "",
    images: Annotated[
        Path | None, typer.Option(help="Write picture files into this new or empty folder instead.")
    ] = None,
    frames: Annotated[int | None, typer.Option(help="With --images: how many; 30 without it.", min=1)] = None,
    seed: Seed = 0,
    duration_s: Duration = None,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Run a webcam that sees markers on a sheet being pressed, as an HTTP MJPEG stream on 127.0.0.1, or as files."""
    with reporting(debug):
        import numpy as np

        from bench_hw.clock import MonotonicClock
        from bench_hw.simulated.camera_server import CameraServer, CameraSettings, write_pictures
        from bench_hw.simulated.picture import CameraModel, Painter
        from bench_hw.simulated.rdt_stream import parse_positions
        from bench_hw.simulated.specimen import pressed_sheet

        of_noise, of_chance = np.random.default_rng(seed).spawn(2)
        painter = Painter(CameraModel(size=_size(size), noise=noise, blur=blur), of_noise)
        markers = pressed_sheet()
        take = partial(_picture, painter.paint, markers)
        if images is not None:
            _check_of_files({"--port": port, "--jitter-s": jitter_s, "--loss": loss, "--drop": drop,
                             "--freeze": freeze, "--duration-s": duration_s})  # fmt: skip
            _check_new(images)
            paths = write_pictures(images, take, [k / rate_hz for k in range(frames or USUAL_FRAMES)])
            return _counted(len(paths), 0, f"pictures in {images}", as_json=as_json, quiet=quiet)
        if frames is not None:
            raise InputError(f"--frames {frames}: a stream ends by --duration-s; allowed with --images FOLDER")
        dropped, frozen = parse_positions(drop), parse_positions(freeze)
        settings = CameraSettings(rate_hz, jitter_s, loss=loss, drop=dropped, freeze=frozen)
        with CameraServer(take, MonotonicClock(), settings, of_chance, port=port) as server:
            _say(f"camera: {server.url}", quiet)
            _serve(duration_s)
        return _counted(server.sent, server.dropped, "frames", as_json=as_json, quiet=quiet)


def session(
    out: Annotated[Path, typer.Option(help="Folder of the session; must be new or empty.")],
    protocol: Annotated[str, typer.Argument(help="Protocol of motion: a path or a shipped name.")] = "paper_press",
    trials: Annotated[int, typer.Option(help="How many trials.")] = 10,
    rate_hz: Annotated[float, typer.Option(help="Force samples per second.", min=1.0, max=7000.0)] = 1000.0,
    with_camera: Annotated[bool, typer.Option("--camera/--no-camera", help="Record pictures, too.")] = True,
    real_time: Annotated[bool, typer.Option("--real-time", help="In real time instead of as fast as can be.")] = False,
    loss: Loss = 0.0,
    drop: Drop = "",
    condition: Annotated[str, typer.Option(help="What the trials share; the protocol's name by default.")] = "",
    specimen: Annotated[
        str,
        typer.Option(help="What is pressed: phantom (a sheet by finite elements), a table like it; a simple sheet."),
    ] = "",
    append: Annotated[bool, typer.Option("--append", help="Add the trials to a session that exists.")] = False,
    seed: Seed = 0,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Record a session with simulated devices: the same as `capture --rig simulated --fast`, with a few changes."""
    with reporting(debug):
        from bench_hw.capture.order import CaptureOrder
        from bench_hw.capture.progress import choose_progress
        from bench_hw.capture.session import capture
        from bench_hw.cli.capture import report_outcome
        from bench_hw.motion.protocol_file import load_protocol
        from bench_hw.rig.rig_file import simulated_rig
        from bench_hw.simulated.tabulated import TabulatedSpecimen, read_sheet

        sheet = TabulatedSpecimen(read_sheet(specimen)) if specimen else None
        force = {"rate": f"{rate_hz:g} Hz", "loss": loss, "drop": drop}
        rig = simulated_rig({"force": force} | ({} if with_camera else {"camera": None}))
        order = CaptureOrder(
            load_protocol(protocol), rig, out, trials, condition, fast=not real_time, append=append, seed=seed
        )
        outcome = capture(order, choose_progress(quiet or as_json), specimen=sheet)
        report_outcome(outcome, as_json=as_json, quiet=quiet)


def _picture(paint: Callable[[Any], Any], markers: Callable[[float], Any], time: float) -> Any:
    return paint(markers(time))


def _serve(duration: float | None) -> None:
    from bench_hw.capture.progress import stop_on_signals

    with stop_on_signals() as stop:
        stop.wait(duration)


def _check_of_files(of_stream: dict[str, float | str | None]) -> None:
    """Refuse the faults and times of a stream where pictures are written as files, which hold no instants."""
    given = [f"{option} {value}" for option, value in of_stream.items() if value not in (None, "", 0)]
    if given:
        raise InputError(
            f"{', '.join(given)}: only the stream has this; allowed with --images are --frames, --rate-hz, --size, "
            "--noise, --blur and --seed"
        )


def _check_new(folder: Path) -> None:
    """Refuse a folder with anything in it, whose pictures would be replaced or mixed with others."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"--images {folder}: is there and not empty; allowed: a folder that is new or empty")


def _say(text: str, quiet: bool) -> None:
    if not quiet:
        print(text, file=sys.stderr, flush=True)


def _counted(sent: int, dropped: int, what: str, *, as_json: bool, quiet: bool) -> None:
    if as_json:
        print_json({"schema": 1, "sent": sent, "dropped": dropped})
    elif not quiet:
        print(f"{sent} {what}, {dropped} dropped (synthetic)")


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal() and 16 <= int(width) <= 10_000 and 16 <= int(height) <= 10_000):
        raise InputError(f"--size {text!r}: allowed is WIDTHxHEIGHT, each from 16 to 10000")
    return int(width), int(height)
