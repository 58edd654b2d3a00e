"""`inspect`: how good a recording is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting

if TYPE_CHECKING:
    from bench_hw.trial_file.inspection import Inspection


def register(app: typer.Typer) -> None:
    """Add the verb."""
    app.command("inspect")(inspect)


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


def _text(inspection: Inspection) -> str:
    state = "complete" if inspection.complete else "NOT complete"
    synthetic = ", synthetic (simulated devices)" if inspection.trial.get("synthetic") else ""
    lines = [f"{inspection.path}: {state}{synthetic}"]
    for name, report in inspection.channels.items():
        figures = (f"{key} {_figure(value)}" for key, value in report.to_dict().items())
        lines.append(f"  {name}: " + ", ".join(figures))
    lines += [f"  fault: {fault}" for fault in inspection.faults]
    return "\n".join(lines)


def _figure(value: float | None) -> str:
    return "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)
