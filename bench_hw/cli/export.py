"""`export`: a trial as plain tables."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting
from bench_hw.errors import InputError


def register(app: typer.Typer) -> None:
    """Add the verb."""
    app.command("export")(export)


def export(
    file: Annotated[Path, typer.Argument(help="A trial, NAME.mcap; of a damaged one what is whole.")],
    out: Annotated[Path, typer.Option(help="The folder to write into; made where it is missing.")],
    parquet: Annotated[bool, typer.Option("--parquet", help="The same tables as Parquet, too.")] = False,
    frames: Annotated[bool, typer.Option("--frames", help="The pictures, too, in OUT/frames.")] = False,
    press_axis: Annotated[
        str, typer.Option(help="Press axis (+x, -x, ... -z) instead of the file's own, for trial.csv.")
    ] = "",
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace tables that exist.")] = False,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Write a trial as plain tables: every raw row of every device, and force over depth.

    force.csv: time_s, force_x_N .. force_z_N, torque_x_Nm .. torque_z_Nm, rdt_sequence, ft_sequence, status (the
    sensor's own axes). depth.csv: time_s, depth_mm, target_mm, counts. camera.csv: time_s, frame, format, bytes.
    trial.csv: time_s, depth_mm, force_N, on the force sensor's time stamps, force positive when pressing, depth
    interpolated between neighbouring positions; gaps stay gaps.
    """
    with reporting(debug):
        from bench_hw.trial_file.export import ExportOptions, export_trial
        from bench_hw.trial_file.metadata import press_axis as checked_axis

        try:
            axis = checked_axis(press_axis) if press_axis else None
        except ValueError as error:
            raise InputError(f"--press-axis: {error}") from error
        result = export_trial(file, out, ExportOptions(parquet, frames, overwrite, axis))
        for warning in result.warnings:
            print(f"warning: {warning}", file=sys.stderr)
        if as_json:
            print_json(result.to_dict())
        elif not quiet:
            print("\n".join(str(written) for written in result.files))
