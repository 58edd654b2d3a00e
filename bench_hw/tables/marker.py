"""Marker tracks as long CSV: `time_s, marker, x_mm, y_mm`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from bench_hw.errors import TableError
from bench_hw.tables.columns import Columns, check_row_count, read_columns
from bench_hw.tables.model import IntArray, MarkerTable
from bench_hw.tables.output import write_columns
from bench_hw.tables.source import read_source
from bench_hw.tables.units import from_si, to_si

MARKER_COLUMNS = ("time_s", "marker", "x_mm", "y_mm")
_MAY_BE_EMPTY = ("x_mm", "y_mm", "confidence")
_LAST_MARKER = 1_000_000


def read_marker_csv(path: Path | str) -> MarkerTable:
    """Read marker tracks from a CSV file.

    Parameters
    ----------
    path : path-like
        Encoding and cells as in `read_trial_csv`; columns `time_s` (s), `marker` (a whole number from 0),
        `x_mm`, `y_mm` (mm). Rows may stand in any order between the markers; for each marker time increases.
        A row whose `x_mm` and `y_mm` are both empty says that the marker was not seen: it is left out, as a
        gap.

    Returns
    -------
    MarkerTable
        Columns of shape (n,) in SI units, rows in the file's order.

    Raises
    ------
    TableError
        As in `read_trial_csv`; also a marker that is no whole number from 0, one coordinate without the
        other, a marker twice at one time.
    """
    path = Path(path)
    columns = read_columns(read_source(path, MARKER_COLUMNS), MARKER_COLUMNS[:2], _MAY_BE_EMPTY)
    marker = _marker_numbers(columns)
    _check_pairs(columns)
    _check_order(columns, marker)
    seen = np.isfinite(columns.values["x_mm"])
    check_row_count(path, int(seen.sum()))
    return MarkerTable(
        time=columns.values["time_s"][seen],
        marker=marker[seen],
        x=to_si(columns.values["x_mm"], "mm")[seen],
        y=to_si(columns.values["y_mm"], "mm")[seen],
        source=str(path),
    )


def _marker_numbers(columns: Columns) -> IntArray:
    values = columns.values["marker"]
    wrong = np.flatnonzero((values != np.floor(values)) | (values < 0) | (values > _LAST_MARKER))
    if len(wrong):
        row, value = int(columns.lines[wrong[0]]), f"{values[wrong[0]]:g}"
        problem, allowed = "the marker is no such number", f"a whole number from 0 to {_LAST_MARKER}"
        raise TableError(columns.path, problem, allowed, row=row, column="marker", value=value)
    return values.astype(np.int64)


def _check_pairs(columns: Columns) -> None:
    x_empty, y_empty = (np.isnan(columns.values[name]) for name in ("x_mm", "y_mm"))
    wrong = np.flatnonzero(x_empty != y_empty)
    if len(wrong):
        name, row = ("x_mm" if x_empty[wrong[0]] else "y_mm"), int(columns.lines[wrong[0]])
        allowed = "both coordinates, or neither where the marker was not seen"
        raise TableError(columns.path, "one coordinate is empty", allowed, row=row, column=name)


def _check_order(columns: Columns, marker: IntArray) -> None:
    time = columns.values["time_s"]
    order = np.argsort(marker, kind="stable")
    same = np.diff(marker[order]) == 0
    wrong = order[1:][same & (np.diff(time[order]) <= 0.0)]
    if len(wrong):
        at = int(wrong.min())
        problem = f"time_s does not increase for marker {marker[at]} at {float(time[at])!r} s"
        allowed = "strictly increasing time for each marker"
        raise TableError(columns.path, problem, allowed, row=int(columns.lines[at]), column="time_s")


def write_marker_csv(path: Path | str, table: MarkerTable) -> Path:
    """Write marker tracks as CSV, whole or not at all, and return the path.

    Time is written exactly, positions with 12 significant digits.

    Raises
    ------
    TableError
        Columns of different length, a number that is not finite, or too few rows.
    OSError
        The folder cannot be written.
    """
    columns = {
        "time_s": table.time,
        "marker": table.marker.astype(np.float64),
        "x_mm": from_si(table.x, "mm"),
        "y_mm": from_si(table.y, "mm"),
    }
    return write_columns(Path(path), columns, exact=("time_s",))
