"""Trial tables as CSV: `time_s, depth_mm, force_N` and whatever else was measured."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from bench_hw.errors import TableError
from bench_hw.tables.columns import check_increasing, check_row_count, read_columns
from bench_hw.tables.model import FloatArray, TrialTable
from bench_hw.tables.output import write_columns
from bench_hw.tables.source import read_source
from bench_hw.tables.units import from_si, join_unit, split_unit, to_si

TRIAL_COLUMNS = ("time_s", "depth_mm", "force_N")


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
        Missing or empty file, missing or doubled column, ragged or blank row, text, NaN or an infinite number
        in a numeric column, time that does not increase, fewer than 20 rows.
    """
    path = Path(path)
    columns = read_columns(read_source(path, TRIAL_COLUMNS), TRIAL_COLUMNS)
    check_increasing(path, "time_s", columns.values["time_s"], columns.lines)
    check_row_count(path, len(columns.lines))
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
