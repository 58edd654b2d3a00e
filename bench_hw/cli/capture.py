"""`capture`: record a session of trials."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting, say_error
from bench_hw.errors import DeviceError, InputError

if TYPE_CHECKING:
    from bench_hw.capture.session import SessionOutcome
    from bench_hw.motion.protocol_file import LoadedProtocol


def register(app: typer.Typer) -> None:
    """Add the verb."""
    app.command("capture")(capture)


def capture(
    protocol: Annotated[str, typer.Argument(help="Protocol of motion: a path or a shipped name.")],
    rig: Annotated[str, typer.Option(help="Rig file, or a shipped rig: `simulated`, `simulated_phantom`.")] = "",
    out: Annotated[Path | None, typer.Option(help="Folder of the session; must be new or empty.")] = None,
    trials: Annotated[int, typer.Option(help="How many trials to record.")] = 1,
    fast: Annotated[bool, typer.Option("--fast", help="Simulated time; for simulated devices only.")] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show the motion and its time; move nothing.")] = False,
    plot: Annotated[Path | None, typer.Option(help="With --dry-run: write the motion as an SVG picture.")] = None,
    condition: Annotated[str, typer.Option(help="What these trials share; the protocol's name by default.")] = "",
    specimen: Annotated[
        str, typer.Option(help="Tissue of the session: a shipped name, or a file to copy into it.")
    ] = "",
    append: Annotated[bool, typer.Option("--append", help="Add the trials to a session that exists.")] = False,
    pause_s: Annotated[float, typer.Option(help="Rest between two trials, s.", min=0.0)] = 0.0,
    seed: Annotated[int | None, typer.Option(help="Of simulated devices; the rig's by default.", min=0)] = None,
    settings: Annotated[
        list[str] | None, typer.Option("--set", help='KEY=VALUE for a new session.toml, such as tool.radius="5 mm".')
    ] = None,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Record a session: one .mcap a trial, session.toml, camera.toml, capture.json.

    All devices are checked before anything moves: a wrong address, serial or calibration ends with exit 5, no
    motion and no trial file. Force limit, travel, stale force data, a lost device and Ctrl-C end the trial with
    the tool going back; what was recorded is in the file, with the fault named in it (exit 5).
    """
    with reporting(debug):
        from bench_hw.motion.protocol_file import load_protocol

        loaded = load_protocol(protocol)
        if dry_run:
            _dry_run(loaded, trials, plot, as_json=as_json)
            return
        if plot is not None:
            raise InputError(f"--plot {plot}: the planned motion is drawn by --dry-run; give both, or neither")
        if not rig or out is None:
            raise InputError("capture needs --rig and --out (or --dry-run)")
        from bench_hw.capture.order import CaptureOrder
        from bench_hw.capture.progress import choose_progress
        from bench_hw.capture.session import capture as record
        from bench_hw.rig.rig_file import load_rig

        keys = _pairs(settings or [])
        specimen = keys.pop("specimen", specimen).strip('"')
        order = CaptureOrder(loaded, load_rig(rig), out, trials, condition, specimen, fast, append, pause_s, seed, keys)
        progress = choose_progress(quiet or as_json)
        _say_setup(loaded, progress.say)
        report_outcome(record(order, progress), as_json=as_json, quiet=quiet)


def _dry_run(loaded: LoadedProtocol, trials: int, plot: Path | None, *, as_json: bool) -> None:
    from bench_hw.motion.plan import drawing, plan, summary, write_plot

    planned = plan(loaded.protocol)
    written = None if plot is None else str(write_plot(planned, plot))
    if as_json:
        print_json(
            {
                "schema": 1,
                "protocol": planned.name,
                "duration_s": planned.duration,
                "trials": trials,
                "total_s": planned.duration * trials,
                "assumed": planned.assumed,
                "steps": [asdict(step) for step in planned.steps],
                "plot": written,
            }
        )
    else:
        print("\n".join([*summary(planned, trials), *drawing(planned)] + ([written] if written else [])))


def _say_setup(loaded: LoadedProtocol, say: Any) -> None:
    for key, value in loaded.protocol.setup.items():
        say(f"to be done by hand first: {key} = {value}")


def report_outcome(outcome: SessionOutcome, *, as_json: bool, quiet: bool) -> None:
    """Print what a capture made; end with exit 5 if a fault ended it."""
    fault = outcome.fault
    if as_json:
        print_json(
            {
                "schema": 1,
                "session": str(outcome.folder),
                "trials": [str(path) for path in outcome.trials],
                "complete": fault is None,
                "fault": None if fault is None else asdict(fault),
            }
        )
    elif not quiet:
        print(f"{len(outcome.trials)} trial(s) in {outcome.folder}")
    if fault is not None:
        say_error(DeviceError(f"{fault.kind}: {fault.message}"))
        raise typer.Exit(DeviceError.exit_code)


def _pairs(settings: list[str]) -> dict[str, str]:
    pairs = {}
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not equals or not key.strip():
            raise InputError(f"--set {setting!r}: allowed is KEY=VALUE")
        pairs[key.strip()] = value.strip()
    return pairs
