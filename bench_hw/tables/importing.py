"""A foreign file to the CSV tables of this bench: columns picked, units turned, everything checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError, TableError
from bench_hw.tables.columns import check_increasing, check_row_count, numbers_of
from bench_hw.tables.foreign import ForeignFormat, ForeignRows, read_foreign
from bench_hw.tables.mapping import ColumnMap
from bench_hw.tables.marker import MARKER_COLUMNS
from bench_hw.tables.model import FloatArray
from bench_hw.tables.output import write_columns
from bench_hw.tables.trial import TRIAL_COLUMNS

SCHEMA = 1
_TIME = "time_s"


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
    """

    source: Path
    columns: Mapping[str, FloatArray]
    taken: Mapping[str, str]
    dropped: int

    @property
    def rows(self) -> int:
        """The number of rows."""
        return len(next(iter(self.columns.values())))


def import_table(path: Path | str, layout: ForeignFormat, plan: ImportPlan) -> Imported:
    """Read a foreign file as a trial table, or as a marker table if `marker` is among the targets.

    Raises
    ------
    TableError
        The file cannot be read or split, a column is missing, a cell is no finite number, time does not
        increase, there are fewer than 20 rows.
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
        columns[item.target] = _adjusted(values, item.target, plan)
    _check_names(plan, columns)
    _check_rows(rows.path, columns[_TIME], lines, is_marker)
    taken = {item.target: item.source for item in maps}
    return Imported(rows.path, columns, taken, len(rows.rows) - len(kept))


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
