"""A trial file as plain tables (CSV, Parquet): every raw row of every device, and force over depth."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TrialFileError
from bench_hw.storage.atomic import replacing, write_bytes
from bench_hw.tables.output import csv_text, exact_cells, rounded_cells
from bench_hw.trial_file.encoding import CAMERA, decode_frame
from bench_hw.trial_file.reading import TrialContents, read_contents, trial_rows
from bench_hw.trial_file.records import PressAxis
from bench_hw.trial_file.scan import read_messages

SCHEMA = 1
FRAMES = "frames"
ExportColumns = Mapping[str, NDArray[Any]]
_ENDINGS = {"jpeg": "jpg", "png": "png", "webp": "webp"}
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
_ROUNDED = ("depth_mm", "target_mm")


@dataclass(frozen=True)
class Export:
    """What an export wrote.

    Parameters
    ----------
    files : tuple of pathlib.Path
        The tables.
    rows : Mapping[str, int]
        Rows by table name.
    frames : int
        Pictures written.
    complete : bool
        Whether the trial is complete; if not, the tables hold what is whole.
    warnings : tuple of str
        What is not in the tables, and why.
    """

    files: tuple[Path, ...]
    rows: Mapping[str, int]
    frames: int
    complete: bool
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Give it as it stands in the JSON of `export`."""
        return {
            "schema": SCHEMA,
            "files": [str(file) for file in self.files],
            "rows": dict(self.rows),
            "frames": self.frames,
            "complete": self.complete,
            "warnings": list(self.warnings),
        }


@dataclass(frozen=True)
class ExportOptions:
    """What to write besides the CSV tables.

    Parameters
    ----------
    parquet : bool
        The same tables as Parquet, too.
    frames : bool
        The pictures, as the camera encoded them, in `frames/`.
    overwrite : bool
        Replace tables that are there.
    press_axis : str, optional
        Instead of the file's own.
    """

    parquet: bool = False
    frames: bool = False
    overwrite: bool = False
    press_axis: PressAxis | None = None


def export_trial(path: Path | str, out: Path | str, options: ExportOptions | None = None) -> Export:
    """Write the tables of a trial into a folder.

    `force.csv`, `depth.csv` and `camera.csv` hold the raw rows in the order they were recorded, `trial.csv` the
    joined rows of `trial_rows`. Times are seconds since the trial's start on one clock. Numbers are written
    exactly, depths in mm with 12 significant digits.

    Parameters
    ----------
    path : path-like
        The trial; of a damaged one what is whole.
    out : path-like
        The folder, made where it is missing.
    options : ExportOptions, optional
        What else to write.

    Raises
    ------
    TrialFileError
        The trial cannot be read, a table is there already, or the folder cannot be written.
    """
    path, out, options = Path(path), Path(out), options or ExportOptions()
    contents = read_contents(path)
    tables, warnings = trial_tables(contents, options.press_axis, with_files=options.frames)
    files = {name: out / f"{name}.csv" for name in tables}
    parquet = {name: out / f"{name}.parquet" for name in tables} if options.parquet else {}
    _check_free([*files.values(), *parquet.values()], options)
    if options.frames and not options.overwrite and (out / FRAMES).exists():
        raise TrialFileError(out / FRAMES, "the pictures exist; give another folder, or `--overwrite` to replace them")
    try:
        with _all_or_none(out, [*files.values(), *parquet.values()], options):
            frames = _write_frames(contents, out) if options.frames else 0
            with ExitStack() as together:  # all are written before the first is put in place
                for name, columns in tables.items():
                    part = together.enter_context(replacing(files[name]))
                    part.write_bytes(csv_text(text_cells(columns)).encode("utf-8"))
                for name, file in parquet.items():
                    _write_parquet(together.enter_context(replacing(file)), tables[name])
    except OSError as error:
        raise TrialFileError(out, f"the folder cannot be written ({error.strerror or error})") from error
    return Export(
        files=(*files.values(), *parquet.values()),
        rows={name: len(columns["time_s"]) for name, columns in tables.items()},
        frames=frames,
        complete=contents.scan.complete,
        warnings=tuple(warnings),
    )


@contextmanager
def _all_or_none(folder: Path, files: list[Path], options: ExportOptions) -> Iterator[None]:
    """Take away again what was put in place, and a folder that was not there before, if not everything could be."""
    there = folder.exists()
    try:
        yield
    except BaseException:
        with suppress(OSError):
            for file in files if not options.overwrite else ():  # none of them was there before
                file.unlink(missing_ok=True)
            if options.frames and not options.overwrite:
                shutil.rmtree(folder / FRAMES, ignore_errors=True)
            if not there:
                folder.rmdir()
        raise


def _check_free(files: list[Path], options: ExportOptions) -> None:
    for file in files:
        if file.exists() and not options.overwrite:
            raise TrialFileError(file, "the table exists; give another folder, or `--overwrite` to replace it")


def _write_frames(contents: TrialContents, folder: Path) -> int:
    """Write the pictures before the table that lists them."""
    count = 0
    for message in read_messages(contents.scan, (CAMERA.topic,)):
        frame = decode_frame(0.0, message.data)
        write_bytes(folder / frame_name(count, frame.format), frame.data)
        count += 1
    return count


def _write_parquet(file: Path, columns: ExportColumns) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    pq.write_table(pa.table({name: pa.array(column, from_pandas=True) for name, column in columns.items()}), file)


def trial_tables(
    contents: TrialContents, press_axis: PressAxis | None = None, *, with_files: bool = False
) -> tuple[dict[str, ExportColumns], list[str]]:
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


def _force_table(contents: TrialContents) -> ExportColumns:
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


def _depth_table(contents: TrialContents) -> ExportColumns:
    depth = contents.depth
    return {
        "time_s": depth.time,
        "depth_mm": depth.depth * 1e3,
        "target_mm": depth.target * 1e3,
        "counts": depth.counts,
    }


def _camera_table(contents: TrialContents, with_files: bool) -> ExportColumns:
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
    return f"{FRAMES}/{row:06d}.{_ENDINGS.get(kind, 'bin')}"


def text_cells(columns: ExportColumns) -> dict[str, list[str]]:
    """Give the columns as CSV cells: numbers exactly, depths with 12 digits, nothing for NaN."""
    return {name: _cells(name, column) for name, column in columns.items()}


def _text_cell(text: str) -> str:
    """Text as a cell: quoted where it must be, with an apostrophe before what a spreadsheet would run."""
    shown = f"'{text}" if text.startswith(_FORMULA) else text
    return '"' + shown.replace('"', '""') + '"' if any(sign in shown for sign in ',"\n\r') else shown


def _cells(name: str, column: NDArray[Any]) -> list[str]:
    if column.dtype.kind in "OU":
        return [_text_cell(str(value)) for value in column.tolist()]
    if column.dtype != np.float64:
        return [str(value) for value in column.tolist()]
    if name == "counts":
        return ["" if np.isnan(value) else str(int(value)) for value in column]
    return list(rounded_cells(column) if name in _ROUNDED else exact_cells(column))
