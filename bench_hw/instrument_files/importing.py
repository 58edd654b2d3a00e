"""CSV files of other rigs to the tables of this bench: any layout read, columns picked, units converted, all checked.

Which column is which, and in which unit, says `ColumnMap` (`units`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError, TableError
from bench_hw.instrument_files import PressRecord, Told, is_plain_trial, read_instrument_file
from bench_hw.instrument_files.text_sheet import Cell, is_number, number_text, text_sheet
from bench_hw.tables.columns import check_increasing, check_row_count, check_size, numbers_of
from bench_hw.tables.measurement import MARKER_COLUMNS, TRIAL_COLUMNS
from bench_hw.tables.output import write_columns
from bench_hw.tables.units import ColumnMap, FloatArray, from_si, join_unit

SCHEMA = 1
_TIME = "time_s"


@dataclass(frozen=True)
class ForeignFormat:
    """How a foreign file is laid out.

    Parameters
    ----------
    delimiter, decimal, encoding : str
        Between cells, in numbers, of the text; "" finds each out from the file.
    skip_lines : int
        Lines above the header.
    header : bool
        Whether there is one.
    skip_rows : int
        Lines between the header and the first row, for instance one with units.
    comment : str
        Lines that begin with it are passed over; "" if there are none.
    """

    delimiter: str = ""
    decimal: str = ""
    encoding: str = ""
    skip_lines: int = 0
    header: bool = True
    skip_rows: int = 0
    comment: str = ""


@dataclass(frozen=True)
class ForeignRows:
    """The cells of a foreign file, blanks around them taken off, decimal signs made points.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    names : tuple of str
        The header's cells; empty without one.
    rows : tuple of list of str
        As many cells as each line has; blank lines are left out.
    lines : tuple of int
        The line of the file of each row, counted from 1.
    """

    path: Path
    names: tuple[str, ...]
    rows: tuple[list[str], ...]
    lines: tuple[int, ...]


def read_foreign(path: Path, layout: ForeignFormat) -> ForeignRows:
    """Split a foreign file into cells.

    Raises
    ------
    TableError
        The file is missing, unreadable, empty, in another encoding, or cannot be split.
    """
    sheet = text_sheet(path, Told(decimal=layout.decimal, delimiter=layout.delimiter, encoding=layout.encoding))
    kept = [
        (line, [str(cell) for cell in row])
        for line, row in zip(sheet.lines, sheet.rows, strict=True)
        if line > layout.skip_lines and any(row) and not _commented(row, layout.comment)
    ]
    if not kept:
        raise TableError(path, "the file is empty", "a header and rows of numbers")
    names: Sequence[str] = ()
    if layout.header:
        (line, names), kept = kept[0], kept[1:]
        if all(is_number(cell, sheet.decimal) for cell in names if cell):
            problem, allowed = "the header is a row of numbers", "names of columns; or --no-header where there are none"
            raise TableError(path, problem, allowed, row=line, value=", ".join(names))
    kept = kept[layout.skip_rows :]
    rows = tuple([number_text(cell, sheet.decimal) for cell in row] for _, row in kept)
    return ForeignRows(path, tuple(names), rows, tuple(line for line, _ in kept))


def _commented(row: Sequence[Cell], comment: str) -> bool:
    return bool(comment) and str(row[0]).startswith(comment)


@dataclass(frozen=True)
class ImportPlan:
    """What becomes of a foreign file's columns.

    Parameters
    ----------
    maps : tuple of ColumnMap
        The columns to take. A required column that is not among them is taken under its own name.
    negate : frozenset of str
        Targets whose sign is turned, for instance a force that is negative when pressing.
    zero : frozenset of str
        Targets that are counted from their first row.
    rate : float or None
        Rows per second, Hz, for a file without times.
    drop_empty : bool
        Leave out rows in which a column that is taken is empty; without it they are refused.
    """

    maps: tuple[ColumnMap, ...] = ()
    negate: frozenset[str] = frozenset()
    zero: frozenset[str] = frozenset()
    rate: float | None = None
    drop_empty: bool = False


@dataclass(frozen=True, eq=False)
class Imported:
    """A table as it will be written.

    Parameters
    ----------
    source : pathlib.Path
        The foreign file.
    columns : Mapping[str, ndarray], each of shape (n,)
        In the units of their names.
    taken : Mapping[str, str]
        Where each column came from.
    dropped : int
        Rows left out because a cell was empty.
    name : str
        Of the sheet or test in its file; "" where that holds but one.
    """

    source: Path
    columns: Mapping[str, FloatArray]
    taken: Mapping[str, str]
    dropped: int
    name: str = ""

    @property
    def rows(self) -> int:
        """The number of rows."""
        return len(next(iter(self.columns.values())))


def import_table(path: Path | str, layout: ForeignFormat, plan: ImportPlan) -> Imported:
    """Read a foreign file as a trial table, or as a marker table if `marker` is among the targets.

    Raises
    ------
    TableError
        The file cannot be read or split, a column is missing, a cell is no finite number or larger than any bench's,
        time does not increase, there are fewer than 20 rows.
    InputError
        `negate` or `zero` name a column that is not taken, or a rate is given beside times.
    """
    rows = read_foreign(Path(path), layout)
    is_marker = any(item.target == "marker" for item in plan.maps)
    maps = _complete(rows, plan, MARKER_COLUMNS if is_marker else TRIAL_COLUMNS)
    cells = {item.target: _column(rows, item) for item in maps}
    kept = _kept_rows(rows, cells, plan)
    lines = np.array(rows.lines, dtype=np.int64)[kept]
    columns = {_TIME: np.arange(len(lines)) / plan.rate} if plan.rate else {}
    for item in maps:
        picked = [cells[item.target][row] for row in kept]
        values = numbers_of(rows.path, item.source, picked, lines, empty=False) * item.factor
        check_size(rows.path, item.target, values, lines)
        columns[item.target] = _adjusted(values, item.target, plan)
    _check_names(plan, columns)
    _check_rows(rows.path, columns[_TIME], lines, is_marker)
    taken = {item.target: item.source for item in maps}
    return Imported(rows.path, columns, taken, len(rows.rows) - len(kept))


def import_tables(path: Path | str, layout: ForeignFormat, plan: ImportPlan) -> list[Imported]:
    """Read all trials of a foreign file: as `plan` maps its columns, or, where it maps none, as they are recognised.

    Raises
    ------
    TableError, InputError
        As `import_table` and `read_instrument_file`.
    """
    path = Path(path)
    told_rows = layout.skip_lines or layout.skip_rows or not layout.header or layout.comment
    if plan.maps or told_rows or is_plain_trial(path):
        return [import_table(path, layout, plan)]
    _check_names(plan, dict.fromkeys((*TRIAL_COLUMNS, "gap_mm"), np.zeros(0)))
    told = Told(
        rate=plan.rate,
        decimal=layout.decimal,
        delimiter=layout.delimiter,
        encoding=layout.encoding,
        drop_empty=plan.drop_empty,
    )
    read = read_instrument_file(path, told)
    several = len(read.records) > 1
    return [_imported(path, each, plan, each.name if several else "") for each in read.records]


def _imported(path: Path, record: PressRecord, plan: ImportPlan, name: str) -> Imported:
    table = record.table
    columns = {_TIME: table.time, "depth_mm": from_si(table.depth, "mm"), "force_N": table.force}
    for extra, values in table.extra.items():
        unit = table.extra_units.get(extra, "")
        columns[join_unit(extra, unit)] = from_si(values, unit)
    taken = {join_unit(role, _UNITS_OF.get(role, "")): shown for role, shown in record.columns.items()}
    columns = {target: _adjusted(values, target, plan) for target, values in columns.items()}
    return Imported(path, columns, taken, 0, name)


_UNITS_OF = {"time": "s", "depth": "mm", "force": "N", "gap": "mm"}


def write_imported(table: Imported, out: Path | str) -> Path:
    """Write an imported table as CSV, whole or not at all, and return its path.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    increasing = "" if "marker" in table.columns else _TIME
    return write_columns(Path(out), table.columns, increasing=increasing, exact=(_TIME,))


def _complete(rows: ForeignRows, plan: ImportPlan, required: tuple[str, ...]) -> list[ColumnMap]:
    targets = [item.target for item in plan.maps]
    for target in targets:
        if targets.count(target) > 1:
            raise InputError(f"--map: {target!r} is given twice; allowed: each target once")
    if plan.rate is not None and (_TIME in targets or plan.rate <= 0.0):
        raise InputError(f"--rate {plan.rate} Hz; allowed: a rate above zero, and no --map of {_TIME}")
    needed = [name for name in required if not (plan.rate and name == _TIME)]
    own_names = [ColumnMap(name, name, 1.0) for name in needed if name not in targets]
    for item in own_names:
        if item.source not in rows.names:
            allowed = f"--map {item.target}=SOURCE:UNIT with a column of the file: {_listed(rows)}"
            raise TableError(rows.path, f"no column for {item.target}", allowed, column=item.target)
    ordered = {item.target: item for item in (*own_names, *plan.maps)}
    return [ordered.pop(name) for name in needed] + list(ordered.values())


def _listed(rows: ForeignRows) -> str:
    return ", ".join(map(repr, rows.names)) or "#1 for the first, #2 for the second..."


def _column(rows: ForeignRows, item: ColumnMap) -> list[str]:
    index = _index(rows, item)
    for cells, line in zip(rows.rows, rows.lines, strict=True):
        if index >= len(cells):
            problem, allowed = f"the row has {len(cells)} cells", f"at least {index + 1}"
            raise TableError(rows.path, problem, allowed, row=line, column=item.source)
    return [cells[index] for cells in rows.rows]


def _index(rows: ForeignRows, item: ColumnMap) -> int:
    count = rows.names.count(item.source)
    if count == 1:
        return rows.names.index(item.source)
    number = item.source.removeprefix("#")
    if not count and item.source.startswith("#") and number.isdecimal() and int(number) > 0:
        return int(number) - 1
    problem = "the column is missing" if not count else f"the column is there {count} times"
    allowed = f"one of {_listed(rows)}, or its place as #N"
    raise TableError(rows.path, problem, allowed, column=item.source)


def _kept_rows(rows: ForeignRows, cells: Mapping[str, list[str]], plan: ImportPlan) -> NDArray[np.int64]:
    every = np.arange(len(rows.rows))
    if not plan.drop_empty:
        return every
    empty = np.zeros(len(every), dtype=bool)
    for column in cells.values():
        empty |= np.array([cell == "" for cell in column], dtype=bool)
    return every[~empty]


def _adjusted(values: FloatArray, target: str, plan: ImportPlan) -> FloatArray:
    values = -values if target in plan.negate else values
    return values - values[0] if target in plan.zero and len(values) else values


def _check_names(plan: ImportPlan, columns: Mapping[str, FloatArray]) -> None:
    for option, names in (("--negate", plan.negate), ("--zero", plan.zero)):
        for name in sorted(names - columns.keys()):
            raise InputError(f"{option} {name!r} is no column of the result; allowed: {', '.join(columns)}")


def _check_rows(path: Path, time: FloatArray, lines: NDArray[np.int64], is_marker: bool) -> None:
    check_row_count(path, len(lines))
    if not is_marker:
        check_increasing(path, _TIME, time, lines)
