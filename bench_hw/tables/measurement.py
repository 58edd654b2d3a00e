"""The two tables the rest of the product gets from a measurement, in SI units, and their CSV files.

A trial is `time_s, depth_mm, force_N` and whatever else was measured; marker tracks are long tables `time_s, marker,
x_mm, y_mm`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TableError
from bench_hw.tables.columns import NumericColumns, check_increasing, check_row_count, read_table
from bench_hw.tables.output import write_columns
from bench_hw.tables.units import FloatArray, from_si, join_unit, split_unit, to_si

IntArray = NDArray[np.int64]
TRIAL_COLUMNS = ("time_s", "depth_mm", "force_N")
MARKER_COLUMNS = ("time_s", "marker", "x_mm", "y_mm")
_MAY_BE_EMPTY = ("x_mm", "y_mm", "confidence")
_LAST_MARKER = 1_000_000


@dataclass(frozen=True, eq=False)
class TrialTable:
    """One trial: press force over depth and time.

    Parameters
    ----------
    time : ndarray, shape (n,)
        s, strictly increasing. A row that is missing is a gap, never filled.
    depth : ndarray, shape (n,)
        m, positive into the tissue, as the actuator reports it.
    force : ndarray, shape (n,)
        N, positive when pressing.
    extra : Mapping[str, ndarray], each of shape (n,)
        Further numeric columns in SI units by their names without the unit (`gap` for the column `gap_mm`).
    source : str
        The file the table came from.
    extra_units : Mapping[str, str]
        The unit each extra column had in its file and gets again when written (`{"gap": "mm"}`); an extra
        without an entry has no unit.
    readings : tuple of ndarray (m,), or None
        Times (s) and depths (m) as the actuator reported them, where `depth` is interpolated between these; else None.
    """

    time: FloatArray
    depth: FloatArray
    force: FloatArray
    extra: Mapping[str, FloatArray] = field(default_factory=dict)
    source: str = ""
    extra_units: Mapping[str, str] = field(default_factory=dict)
    readings: tuple[FloatArray, FloatArray] | None = None


@dataclass(frozen=True, eq=False)
class MarkerTable:
    """Marker positions in long form: one row per marker and frame in which it was seen.

    Parameters
    ----------
    time : ndarray, shape (n,)
        s, on the trial's clock at the camera's own instants; strictly increasing for each marker.
    marker : ndarray of int, shape (n,)
        Number of the marker.
    x, y : ndarray, shape (n,)
        m, in the face's plane, origin at the grid's nominal centre.
    source : str
        The file the table came from.
    """

    time: FloatArray
    marker: IntArray
    x: FloatArray
    y: FloatArray
    source: str = ""


LONE = 3.0
"""Times the range of all other rows by which a single row stands out that no press makes."""


def calm(force: FloatArray) -> FloatArray:
    """A force with single rows replaced that stand beyond all others by far more than those reach: glitches."""
    if len(force) < 3:
        return force
    before, after = np.append(force[1], force[:-1]), np.append(force[1:], force[-2])
    middle = np.clip(force, np.minimum(before, after), np.maximum(before, after))
    return np.where(np.abs(force - middle) > LONE * float(np.ptp(middle)), middle, force)


SUMMED = 1e-3
"""How near the last row of a table is to the sums of the others, relative, to be their totals."""


def check_totals(path: Path, columns: Mapping[str, FloatArray], lines: IntArray) -> None:
    """Refuse a last row that holds the sums of the columns, as a spreadsheet's totals do.

    Parameters
    ----------
    path : pathlib.Path
        For the error.
    columns : Mapping[str, ndarray], each of shape (n,)
        Depth and force, in any unit.
    lines : ndarray of int, shape (n,)
        The line of the file of each row.

    Raises
    ------
    TableError
        Each column's last number is the sum of the others, and far beyond all of them.
    """
    for values in columns.values():
        total = float(values[:-1].sum()) if len(values) > 2 else 0.0
        beyond = abs(total) > LONE * float(np.abs(values[:-1]).max(initial=0.0))
        if not beyond or abs(float(values[-1]) - total) > SUMMED * abs(total):
            return
    problem = f"the last row holds the sums of the columns {' and '.join(columns)}"
    raise TableError(path, problem, "rows of the record alone: take it out", row=int(lines[-1]))


def read_trial_csv(path: Path | str) -> TrialTable:
    """Read a trial from a CSV file.

    Parameters
    ----------
    path : path-like
        UTF-8 (with or without byte-order mark), LF or CRLF, cells separated by commas, a header with at least
        `time_s` (s, strictly increasing), `depth_mm` (mm, positive into the tissue) and `force_N` (N,
        positive when pressing), no comments, at least 20 rows. Further numeric columns are carried along;
        where the name ends in a unit (`gap_mm`) they are turned into SI (`gap`). Further text columns are
        left out.

    Returns
    -------
    TrialTable
        Columns of shape (n,) in SI units.

    Raises
    ------
    TableError
        Missing or empty file, missing or duplicated column, ragged or blank row, text, NaN or an infinite number
        in a numeric column, time that does not increase, fewer than 20 rows.
    """
    path = Path(path)
    columns = read_table(path, TRIAL_COLUMNS)
    check_increasing(path, "time_s", columns.values["time_s"], columns.lines)
    check_row_count(path, len(columns.lines))
    check_totals(path, {name: columns.values[name] for name in TRIAL_COLUMNS[1:]}, columns.lines)
    si, units = _in_si(path, columns.values)
    time, depth, force = (si.pop(name) for name in ("time", "depth", "force"))
    extra_units = {name: units[name] for name in si if units[name]}
    return TrialTable(time, depth, force, extra=si, source=str(path), extra_units=extra_units)


def _in_si(path: Path, values: Mapping[str, FloatArray]) -> tuple[dict[str, FloatArray], dict[str, str]]:
    si: dict[str, FloatArray] = {}
    units: dict[str, str] = {}
    for column, numbers in values.items():
        quantity, unit = split_unit(column)
        if quantity in si:
            first = join_unit(quantity, units[quantity])
            problem = f"the columns {first!r} and {column!r} are the same quantity"
            raise TableError(path, problem, "one column for each quantity", row=1, column=column)
        si[quantity] = to_si(numbers, unit)
        units[quantity] = unit
    return si, units


def write_trial_csv(path: Path | str, table: TrialTable) -> Path:
    """Write a trial as CSV, whole or not at all, and return its path.

    Time is written exactly (shortest decimal that reads back the same), everything else with 12 significant
    digits. An extra column gets the unit `table.extra_units` names.

    Raises
    ------
    TableError
        The table would be refused by `read_trial_csv`: too short, not finite, time that does not increase,
        columns of different length.
    OSError
        The folder cannot be written.
    """
    columns = {
        "time_s": table.time,
        "depth_mm": from_si(table.depth, "mm"),
        "force_N": table.force,
    }
    for name, numbers in table.extra.items():
        unit = table.extra_units.get(name, "")
        columns[join_unit(name, unit)] = from_si(numbers, unit)
    return write_columns(Path(path), columns, increasing="time_s", exact=("time_s",))


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
    columns = read_table(path, MARKER_COLUMNS, _MAY_BE_EMPTY)
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


def _marker_numbers(columns: NumericColumns) -> IntArray:
    values = columns.values["marker"]
    wrong = np.flatnonzero((values != np.floor(values)) | (values < 0) | (values > _LAST_MARKER))
    if len(wrong):
        row, value = int(columns.lines[wrong[0]]), f"{values[wrong[0]]:g}"
        problem, allowed = "the marker is no such number", f"a whole number from 0 to {_LAST_MARKER}"
        raise TableError(columns.path, problem, allowed, row=row, column="marker", value=value)
    return values.astype(np.int64)


def _check_pairs(columns: NumericColumns) -> None:
    x_empty, y_empty = (np.isnan(columns.values[name]) for name in ("x_mm", "y_mm"))
    wrong = np.flatnonzero(x_empty != y_empty)
    if len(wrong):
        name, row = ("x_mm" if x_empty[wrong[0]] else "y_mm"), int(columns.lines[wrong[0]])
        allowed = "both coordinates, or neither where the marker was not seen"
        raise TableError(columns.path, "one coordinate is empty", allowed, row=row, column=name)


def _check_order(columns: NumericColumns, marker: IntArray) -> None:
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
