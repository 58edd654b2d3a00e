"""A CSV file as columns of numbers: bytes decoded, header checked, cells split, turned into numbers and checked.

A body that holds nothing but digits, signs, points, exponents and commas is parsed by NumPy as a whole; anything else
(text columns, quotes, every kind of error) is split cell by cell. Every refusal names the file, the line, the column,
the cell and what is allowed. What the numbers mean is for `measurement`.
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TableError
from bench_hw.storage.regular_file import TABLE, open_regular, read_regular
from bench_hw.tables.units import UNITS, FloatArray, split_unit

MINIMUM_ROWS = 20
"""A measured table with fewer rows than this is refused."""

LARGEST = {"s": 1e10, "m": 1e3, "N": 1e9}
"""Largest magnitudes of a measured time, length and force, SI: squares of what is larger overflow in a fit."""

LARGE = 16_000_000
"""Bytes of a file from which on it is read piece by piece."""
PIECE = 4_000_000
_LONGEST_HEADER = 100_000
_NUMERIC_BYTES = b"0123456789+-.eE,\n \t"
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True, eq=False)
class CsvText:
    r"""A CSV file, decoded.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    names : tuple of str
        The column names, blanks around them taken off.
    body : str
        The text below the header, with `\n` at the ends of lines.
    """

    path: Path
    names: tuple[str, ...]
    body: str


def read_source(path: Path, required: Sequence[str]) -> CsvText:
    """Read and decode a file and check its header.

    Parameters
    ----------
    path : pathlib.Path
        UTF-8 with or without a byte-order mark, lines ending in LF or CRLF, cells separated by commas.
    required : sequence of str
        The columns that must be there.

    Raises
    ------
    TableError
        The file is missing, unreadable, empty or no UTF-8; a column is missing or duplicated.
    """
    text = _decoded(path, _bytes_of(path)).replace("\r\n", "\n").replace("\r", "\n")
    if not text.strip():
        raise TableError(path, "the file is empty", f"a header with {', '.join(required)} and rows of numbers")
    header, _, body = text.partition("\n")
    names = tuple(name for _, cells in _records(path, header, 1) for name in cells)
    _check_names(path, names, required)
    return CsvText(path, names, _without_empty_end(body))


def _without_empty_end(body: str) -> str:
    """The rows without those at the end that hold nothing but commas, as spreadsheets write cells that were cleared."""
    kept = body.rstrip("\n")
    while kept and not kept[(start := kept.rfind("\n") + 1) :].strip(", \t"):
        kept = kept[:start].rstrip("\n")
    return kept


def _bytes_of(path: Path) -> bytes:
    allowed = "the path of a readable CSV file"
    try:
        return read_regular(path, TABLE)
    except FileNotFoundError as error:
        raise TableError(path, "no such file", allowed) from error
    except OSError as error:
        raise TableError(path, f"the file cannot be read ({error.strerror})", allowed) from error


def _decoded(path: Path, raw: bytes) -> str:
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        row = raw.count(b"\n", 0, error.start) + 1
        value = f"byte 0x{raw[error.start]:02x}"
        raise TableError(path, "the file is no UTF-8 text", "UTF-8", row=row, value=value) from error


def _check_names(path: Path, names: tuple[str, ...], required: Sequence[str]) -> None:
    listed = ", ".join(repr(name) for name in names)
    for name in required:
        if name not in names:
            allowed = f"a header, separated by commas, with {', '.join(required)} (it has {listed})"
            raise TableError(path, "the column is missing", allowed, row=1, column=name)
    for name, count in Counter(names).items():
        if count > 1 and name:
            raise TableError(path, f"the column is there {count} times", "each name once", row=1, column=name)


def read_table(path: Path, required: Sequence[str], may_be_empty: Collection[str] = ()) -> NumericColumns:
    """Read a file of numbers: a large one piece by piece where it is plain, in a few times the memory of its numbers.

    As `read_columns` of `read_source`, which reads what is small, and what holds anything but numbers.
    """
    return _streamed(path, required) or read_columns(read_source(path, required), required, may_be_empty)


def _streamed(path: Path, required: Sequence[str]) -> NumericColumns | None:
    """The columns of a large file that is numbers throughout; None for any other, and where anything is odd."""
    try:
        with open_regular(path, TABLE) as stream:
            if os.fstat(stream.fileno()).st_size < LARGE:
                return None
            header = stream.readline(_LONGEST_HEADER).decode("utf-8-sig").rstrip("\r\n")
            names = tuple(name for _, cells in _records(path, header, 1) for name in cells)
            _check_names(path, names, required)
            pieces = [_piece(lines, len(names)) for lines in iter(lambda: stream.readlines(PIECE), [])]
    except (OSError, ValueError):
        return None
    plain = [piece for piece in pieces if piece is not None]
    if not plain or len(plain) < len(pieces):
        return None
    lines = np.arange(2, sum(map(len, plain)) + 2)
    values = {name: np.concatenate([piece[:, k] for piece in plain]) for k, name in enumerate(names) if name}
    for name, column in values.items():
        _check_finite(path, name, column, lines)
        check_size(path, name, column, lines)
    return NumericColumns(path, values, lines)


def _piece(lines: list[bytes], columns: int) -> FloatArray | None:
    """The numbers of some lines, (rows, columns); None where they are anything else."""
    if b"".join(lines).translate(None, _NUMERIC_BYTES + b"\r"):
        return None
    matrix = np.loadtxt(lines, delimiter=",", comments=None, ndmin=2)
    return matrix if matrix.shape == (len(lines), columns) else None


def numeric_matrix(source: CsvText) -> FloatArray | None:
    """Parse a body that is numbers throughout; None where it is not, or where anything is odd.

    Returns
    -------
    ndarray, shape (rows, columns), or None
        Row i stands in line i + 2 of the file.
    """
    body = source.body.rstrip("\n")
    if not body.isascii() or body.encode().translate(None, _NUMERIC_BYTES) or not body:
        return None
    try:
        matrix = np.loadtxt(io.StringIO(body), delimiter=",", comments=None, ndmin=2)
    except ValueError:
        return None
    as_written = (body.count("\n") + 1, len(source.names))
    return matrix if matrix.shape == as_written else None


def text_columns(source: CsvText) -> tuple[list[tuple[str, ...]], list[int]]:
    """Split the body into columns of cells, blanks around them taken off.

    Returns
    -------
    columns : list of tuples of str
        One tuple of cells per column of the header.
    lines : list of int
        The line of the file each row stands in.

    Raises
    ------
    TableError
        A row that is blank, has too few or too many cells, or is longer than a line.
    """
    rows, lines = [], []
    for line, cells in _records(source.path, source.body.rstrip(), 2):
        if len(cells) != len(source.names):
            problem = f"the row has {len(cells)} cells" if cells else "the row is blank"
            raise TableError(source.path, problem, f"{len(source.names)} cells, as in the header", row=line)
        rows.append(cells)
        lines.append(line)
    return (list(zip(*rows, strict=True)) if rows else [() for _ in source.names]), lines


def _records(path: Path, text: str, first_line: int) -> Iterator[tuple[int, list[str]]]:
    """Split text into records with their lines; one that spans several lines is refused."""
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    line = first_line - 1
    try:
        for line, cells in enumerate(reader, start=first_line):
            if reader.line_num != line - first_line + 1:
                raise csv.Error("a quoted cell spans several lines")
            yield line, [cell.strip() for cell in cells]
    except csv.Error as error:
        allowed = "cells separated by commas, one line per row"
        raise TableError(path, f"the row cannot be split ({error})", allowed, row=line + 1) from error


@dataclass(frozen=True, eq=False)
class NumericColumns:
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


def read_columns(source: CsvText, required: Sequence[str], may_be_empty: Collection[str] = ()) -> NumericColumns:
    """Turn a file's cells into numbers.

    Parameters
    ----------
    source : CsvText
        The file.
    required : sequence of str
        Columns that must be numbers throughout; so must every column whose name ends in a unit. Another
        column is left out unless it is numbers throughout, and so is one without a name.
    may_be_empty : collection of str
        Columns in which an empty cell is allowed and becomes NaN.

    Raises
    ------
    TableError
        A ragged or blank row, or a cell that is no finite number, or larger than a bench measures.
    """
    matrix = numeric_matrix(source)
    if matrix is not None:
        lines = np.arange(2, len(matrix) + 2)
        values = {name: matrix[:, index] for index, name in enumerate(source.names) if name}
        for name, column in values.items():
            _check_finite(source.path, name, column, lines)
            check_size(source.path, name, column, lines)
        return NumericColumns(source.path, values, lines)
    columns, line_list = text_columns(source)
    lines = np.array(line_list, dtype=np.int64)
    values = {}
    for name, cells in zip(source.names, columns, strict=True):
        if not name:
            continue
        strict = name in required or name in may_be_empty or split_unit(name)[1] != ""
        if strict or all(map(_NUMBER.fullmatch, cells)):
            values[name] = numbers_of(source.path, name, cells, lines, empty=name in may_be_empty)
            check_size(source.path, name, values[name], lines)
    return NumericColumns(source.path, values, lines)


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


def check_size(path: Path, name: str, column: FloatArray, lines: NDArray[np.int64]) -> None:
    """Refuse a time, length or force that no bench measures, by the unit of its column's name; NaN passes.

    Raises
    ------
    TableError
        Names the first row.
    """
    factor, unit = UNITS.get(split_unit(name)[1], (None, ""))
    if factor is None or unit not in LARGEST:
        return
    most = LARGEST[unit] / float(factor)
    wrong = np.flatnonzero(np.abs(column) > most)
    if len(wrong):
        row, value = int(lines[wrong[0]]), f"{column[wrong[0]]:g}"
        allowed = f"numbers from {-most:g} to {most:g}"
        raise TableError(path, "the number is too large", allowed, row=row, column=name, value=value)


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
