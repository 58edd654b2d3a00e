"""Columns of numbers to CSV text, checked before anything is written."""

from __future__ import annotations

import csv
import io
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

import numpy as np

from bench_hw.errors import TableError
from bench_hw.storage.atomic import write_text
from bench_hw.tables.columns import check_increasing, check_row_count
from bench_hw.tables.units import FloatArray


def write_columns(
    path: Path, columns: Mapping[str, FloatArray], *, increasing: str = "", exact: Collection[str] = ()
) -> Path:
    """Write numeric columns as a CSV table that the readers of this package accept.

    Parameters
    ----------
    path : pathlib.Path
        The file to make or replace.
    columns : Mapping[str, ndarray], each of shape (n,)
        By header name, in the units of the header.
    increasing : str
        A column that must increase strictly.
    exact : collection of str
        Columns written with the shortest decimal that reads back the same; others get 12 significant digits.

    Raises
    ------
    TableError
        Columns of different length, numbers that are not finite, too few rows; the row named is the line the
        number would have stood in.
    OSError
        The folder cannot be written.
    """
    count = len(next(iter(columns.values())))
    lines = np.arange(2, count + 2)
    for name, values in columns.items():
        if values.shape != (count,):
            allowed = f"shape ({count},), as the first column"
            raise TableError(path, f"the column has shape {values.shape}", allowed, row=1, column=name)
        wrong = np.flatnonzero(~np.isfinite(values))
        if len(wrong):
            row, value = int(lines[wrong[0]]), f"{values[wrong[0]]}"
            raise TableError(path, "not finite", "finite numbers", row=row, column=name, value=value)
    check_row_count(path, count)
    if increasing:
        check_increasing(path, increasing, columns[increasing], lines)
    cells = {name: exact_cells(values) if name in exact else rounded_cells(values) for name, values in columns.items()}
    return write_text(path, csv_text(cells))


def exact_cells(values: FloatArray) -> Iterable[str]:
    """Give the shortest decimals that read back the same; nothing for NaN."""
    return ("" if number != number else repr(number) for number in values.tolist())


def rounded_cells(values: FloatArray) -> Iterable[str]:
    """Give 12 significant digits; nothing for NaN."""
    return ("" if number != number else f"{number:.12g}" for number in values.tolist())


def csv_text(columns: Mapping[str, Iterable[str]]) -> str:
    """Join columns of cells that need no quotes into CSV text with a header."""
    header = io.StringIO()
    csv.writer(header, lineterminator="\n").writerow(columns)
    return header.getvalue() + "".join(",".join(row) + "\n" for row in zip(*columns.values(), strict=True))
