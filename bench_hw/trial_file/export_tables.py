"""The tables an export holds, as columns in the units of their names."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench_hw.tables.output import exact_cells, rounded_cells
from bench_hw.trial_file.contents import TrialContents
from bench_hw.trial_file.records import PressAxis
from bench_hw.trial_file.trial_table import trial_rows

Columns = Mapping[str, NDArray[Any]]
_ENDINGS = {"jpeg": "jpg", "png": "png", "webp": "webp"}
_ROUNDED = ("depth_mm", "target_mm")


def trial_tables(
    contents: TrialContents, press_axis: PressAxis | None = None, *, with_files: bool = False
) -> tuple[dict[str, Columns], list[str]]:
    """Give the tables of a trial by name, and a sentence for each thing that is not in them.

    Parameters
    ----------
    contents : TrialContents
        What the file holds.
    press_axis : str, optional
        Instead of the file's own.
    with_files : bool
        Whether the camera's table names the files of its pictures.
    """
    tables = {
        "force": _force_table(contents),
        "depth": _depth_table(contents),
        "camera": _camera_table(contents, with_files),
    }
    warnings = [f"not complete: {damage}" for damage in contents.scan.damages] + contents.scan.losses()
    if press_axis is None and contents.header is None:
        return tables, [*warnings, "no trial.csv: the press axis is lost with the metadata, give it"]
    trial = trial_rows(contents, press_axis)
    if not len(trial.time):
        return tables, [*warnings, "no trial.csv: no row has both force and depth"]
    tables["trial"] = {"time_s": trial.time, "depth_mm": trial.depth * 1e3, "force_N": trial.force}
    return tables, warnings


def _force_table(contents: TrialContents) -> Columns:
    force = contents.force
    vectors = {
        **{f"force_{axis}_N": force.force[:, index] for index, axis in enumerate("xyz")},
        **{f"torque_{axis}_Nm": force.torque[:, index] for index, axis in enumerate("xyz")},
    }
    numbers = {
        "rdt_sequence": force.rdt_sequence,
        "ft_sequence": force.ft_sequence,
        "status": force.status,
    }
    return {"time_s": force.time, **vectors, **numbers}


def _depth_table(contents: TrialContents) -> Columns:
    depth = contents.depth
    return {
        "time_s": depth.time,
        "depth_mm": depth.depth * 1e3,
        "target_mm": depth.target * 1e3,
        "counts": depth.counts,
    }


def _camera_table(contents: TrialContents, with_files: bool) -> Columns:
    camera = contents.camera
    columns = {
        "time_s": camera.time,
        "frame": camera.frame,
        "format": np.array(camera.format, dtype=object),
        "bytes": camera.size,
    }
    if with_files:
        names = [frame_name(row, kind) for row, kind in enumerate(camera.format)]
        columns["file"] = np.array(names, dtype=object)
    return columns


def frame_name(row: int, kind: str) -> str:
    """Give the name of the file of a picture, by its row and the name of its encoding."""
    return f"frames/{row:06d}.{_ENDINGS.get(kind, 'bin')}"


def text_cells(columns: Columns) -> dict[str, list[str]]:
    """Give the columns as CSV cells: numbers exactly, depths with 12 digits, nothing for NaN."""
    return {name: _cells(name, column) for name, column in columns.items()}


def _cells(name: str, column: NDArray[Any]) -> list[str]:
    if column.dtype != np.float64:
        return [str(value) for value in column.tolist()]
    if name == "counts":
        return ["" if np.isnan(value) else str(int(value)) for value in column]
    return list(rounded_cells(column) if name in _ROUNDED else exact_cells(column))
