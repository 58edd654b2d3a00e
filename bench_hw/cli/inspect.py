"""`inspect` and `recover`: how good a recording is, and what is whole of one that is not."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting

if TYPE_CHECKING:
    from bench_hw.trial_file.inspection import Inspection

SMALLEST_MS = 1e-3
"""The shortest time in ms that is shown as a number: no clock of a bench is as good."""


def register(app: typer.Typer) -> None:
    """Add the verbs."""
    app.command("inspect")(inspect)
    app.command("recover")(recover)


def inspect(
    file: Annotated[Path, typer.Argument(help="A trial, NAME.mcap; also one that is cut, or NAME.mcap.part.")],
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Say how good a recording is: rates, jitter, gaps, losses, saturation, damage.

    Per channel (force, depth, camera; times on one clock, s since the trial's start): rows, rate_hz, lost
    (records that never came between the first and the last), gaps, reordered, duplicates, restarts, jitter_ms,
    longest_interval_s; for force also saturated rows and drift_N (unloaded force at the end less that at the
    beginning; empty where the actuator did not come back). Exit 0 also for a cut file with anything whole in it:
    then `complete` is false.
    """
    with reporting(debug):
        from bench_hw.trial_file.inspection import inspect_trial

        inspection = inspect_trial(file)
        if as_json:
            print_json(inspection.to_dict())
        elif not quiet:
            print(_text(inspection))


def recover(
    file: Annotated[Path, typer.Argument(help="A trial: cut, damaged, or still named NAME.mcap.part.")],
    out: Annotated[Path, typer.Option(help="The new trial, NEW.mcap; must not exist.")],
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Save what is whole in a cut or damaged trial into a new file; the original is only read.

    Every message keeps its bytes, its times and its place; chunks after a damaged one are kept. Exit 0 where
    something was kept; exit 2 and no file where nothing was.
    """
    with reporting(debug):
        from bench_hw.trial_file.recovery import recover_trial

        recovery = recover_trial(file, out)
        if as_json:
            print_json(recovery.to_dict())
        elif not quiet:
            kept = ", ".join(f"{count} {name}" for name, count in recovery.kept.items())
            print(f"{recovery.out}: kept {kept}")
            print("whole, nothing is lost" if recovery.whole else f"lost: {recovery.lost_bytes} bytes")
            if recovery.reason:
                print(f"found: {recovery.reason}")


def _text(inspection: Inspection) -> str:
    state = "complete" if inspection.complete else "NOT complete"
    synthetic = ", synthetic (simulated devices)" if inspection.trial.get("synthetic") else ""
    lines = [f"{inspection.path}: {state}{synthetic}"]
    for name, report in inspection.channels.items():
        figures = (f"{key} {_figure(key, value)}" for key, value in report.to_dict().items())
        lines.append(f"  {name}: " + ", ".join(figures))
    lines += [f"  fault: {fault}" for fault in inspection.faults]
    return "\n".join(lines)


def _figure(key: str, value: float | None) -> str:
    """A figure as people read it: thousandths of a millisecond, and six digits of anything else."""
    if value is None:
        return "-"
    if key.endswith("_ms"):
        return f"below {SMALLEST_MS:g}" if 0.0 < value < SMALLEST_MS else f"{value:.6g}"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
