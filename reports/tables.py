"""Result tables as CSV: UTF-8, comma, one header row, units in the column names.

Formatting numbers for people to read is in `reports.formatting`.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

from reports.atomic import StrPath, write_text


def write_csv(path: StrPath, columns: Mapping[str, Sequence[Any] | Any]) -> Path:
    """Write columns of equal length to a CSV file, whole or not at all.

    Numbers are written with the shortest text that reads back to the same double, up to 17 digits.
    None and NaN become empty cells, booleans `true` and `false`. Text that a spreadsheet would take for a formula, in a
    column's name too, gets an apostrophe before it; `read_cell` takes it off.

    Parameters
    ----------
    path
        File to write.
    columns
        Column name (with its unit, e.g. `force_N`) to values: a sequence or an array of shape (n,).

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ValueError
        For no column, an empty name, a column that is not one-dimensional, or columns of different lengths.
    TypeError
        For a cell that is no number, text, boolean or None.
    """
    return write_text(path, csv_text(columns, where=str(path)))


def csv_text(columns: Mapping[str, Sequence[Any] | Any], where: str = "table") -> str:
    """Return the text `write_csv` writes, e.g. to embed it in a page.

    Parameters
    ----------
    columns
        As in `write_csv`.
    where
        Name of the table in the message of an error.
    """
    if not columns or not all(columns):
        raise ValueError(f"{where}: a table needs at least one column, each with a name; got {list(columns)}")
    values = {name: _values(column, f"{where}: column {name!r}") for name, column in columns.items()}
    if len({len(column) for column in values.values()}) > 1:
        lengths = ", ".join(f"{name} {len(column)}" for name, column in values.items())
        raise ValueError(f"{where}: all columns must have as many rows as the first; got {lengths}")
    cells = {
        name: [_cell(value, f"{where}: column {name!r}, row {row}") for row, value in enumerate(column, 1)]
        for name, column in values.items()
    }
    lines: list[str] = []
    # The writer quotes a lone carriage return only if its own line ends hold one.
    writer = csv.writer(cast(Any, SimpleNamespace(write=lines.append)), lineterminator="\r\n")
    writer.writerow([_cell(name, where) for name in cells])
    writer.writerows(zip(*cells.values(), strict=True))
    return "".join(line.removesuffix("\r\n") + "\n" for line in lines)


_FORMULA = re.compile(r"'*(?![+-]?[\d.]+(?:[eE][+-]?\d+)?$)[=+\-@\t\r]")
"""How a text begins that a spreadsheet runs, or one that has its apostrophe already; a number is none."""


def read_cell(text: str) -> str:
    """The text that was written as a cell: without the apostrophe before what a spreadsheet would run."""
    return text[1:] if text.startswith("'") and _FORMULA.match(text) else text


def _values(column: Any, where: str) -> list[Any]:
    """Return a column as a list of plain values."""
    if getattr(column, "ndim", 1) != 1:
        raise ValueError(f"{where} has {column.ndim} dimensions, a column has one")
    if isinstance(column, str | bytes):
        raise ValueError(f"{where} is one text, a column is a sequence of values")
    return list(column.tolist()) if hasattr(column, "tolist") else list(column)


def _cell(value: Any, where: str) -> str:
    """Return one cell's text."""
    if value is None:
        return ""
    if isinstance(value, str):
        return f"'{value}" if _FORMULA.match(value) else value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(int(value))
    if isinstance(value, float):
        return "" if math.isnan(value) else float.__repr__(value)
    if hasattr(value, "item"):
        return _cell(value.item(), where)
    raise TypeError(f"{where} is a {type(value).__name__}; a cell is a number, text, boolean or None")
