"""Cells to numbers, and the checks every measured table passes: finite, long enough, time that increases.

Every refusal names the file, the line, the column, the cell and what is allowed.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TableError
from bench_hw.tables.model import MINIMUM_ROWS, FloatArray
from bench_hw.tables.source import Source, numeric_matrix, text_columns
from bench_hw.tables.units import split_unit

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True, eq=False)
class Columns:
    """The numeric columns of a file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    values : Mapping[str, ndarray], each of shape (n,)
        By the names of the header, in the file's units, finite; NaN only where an empty cell was allowed.
    lines : ndarray of int, shape (n,)
        The line of the file of each row.
    """

    path: Path
    values: Mapping[str, FloatArray]
    lines: NDArray[np.int64]


def read_columns(source: Source, required: Sequence[str], may_be_empty: Collection[str] = ()) -> Columns:
    """Turn a file's cells into numbers.

    Parameters
    ----------
    source : Source
        The file.
    required : sequence of str
        Columns that must be numbers throughout; so must every column whose name ends in a unit. Another
        column is left out unless it is numbers throughout.
    may_be_empty : collection of str
        Columns in which an empty cell is allowed and becomes NaN.

    Raises
    ------
    TableError
        A ragged or blank row, or a cell that is no finite number.
    """
    matrix = numeric_matrix(source)
    if matrix is not None:
        lines = np.arange(2, len(matrix) + 2)
        values = {name: matrix[:, index] for index, name in enumerate(source.names)}
        for name, column in values.items():
            _check_finite(source.path, name, column, lines)
        return Columns(source.path, values, lines)
    columns, line_list = text_columns(source)
    lines = np.array(line_list, dtype=np.int64)
    values = {}
    for name, cells in zip(source.names, columns, strict=True):
        strict = name in required or name in may_be_empty or split_unit(name)[1] != ""
        if strict or all(map(_NUMBER.fullmatch, cells)):
            values[name] = numbers_of(source.path, name, cells, lines, empty=name in may_be_empty)
    return Columns(source.path, values, lines)


def numbers_of(path: Path, name: str, cells: Sequence[str], lines: NDArray[np.int64], *, empty: bool) -> FloatArray:
    """Turn the cells of one column into numbers.

    Parameters
    ----------
    path, name : pathlib.Path, str
        For the error.
    cells : sequence of str, length n
        Without blanks around them.
    lines : ndarray of int, shape (n,)
        The line of the file of each cell, for the error.
    empty : bool
        Whether an empty cell is allowed; it becomes NaN.

    Raises
    ------
    TableError
        Names the first cell that is no finite number.
    """
    wrong = [i for i, cell in enumerate(cells) if not _NUMBER.fullmatch(cell) and not (empty and not cell)]
    if wrong:
        cell, row = cells[wrong[0]], int(lines[wrong[0]])
        problem = "the cell is no finite number" if cell else "the cell is empty"
        raise TableError(path, problem, "a finite number", row=row, column=name, value=cell)
    column = np.array([cell or "nan" for cell in cells] if empty else cells, dtype=np.float64)
    filled = np.array([cell != "" for cell in cells], dtype=bool)
    _check_finite(path, name, column[filled], lines[filled])
    return column


def _check_finite(path: Path, name: str, column: FloatArray, lines: NDArray[np.int64]) -> None:
    wrong = np.flatnonzero(~np.isfinite(column))
    if len(wrong):
        row, value = int(lines[wrong[0]]), f"{column[wrong[0]]}"
        problem = "the number is beyond what a double holds"
        raise TableError(path, problem, "a finite number", row=row, column=name, value=value)


def check_increasing(path: Path, name: str, column: FloatArray, lines: NDArray[np.int64]) -> None:
    """Refuse a column that does not increase strictly from row to row.

    Raises
    ------
    TableError
        Names the first row that is not after the one before it.
    """
    wrong = np.flatnonzero(np.diff(column) <= 0.0)
    if len(wrong):
        before, at = wrong[0], wrong[0] + 1
        problem = f"{name} does not increase: {float(column[at])!r} follows {float(column[before])!r}"
        raise TableError(path, problem, "strictly increasing", row=int(lines[at]), column=name)


def check_row_count(path: Path, count: int) -> None:
    """Refuse a table of fewer than `MINIMUM_ROWS` rows.

    Raises
    ------
    TableError
        Names the count.
    """
    if count < MINIMUM_ROWS:
        raise TableError(path, f"the table has {count} rows", f"at least {MINIMUM_ROWS} rows")
