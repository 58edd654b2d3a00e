"""CSV files of other rigs: any delimiter, decimal sign, encoding and lines around the numbers.

Only cells come out of here; which of them is what, and in which unit, is for `mapping`.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from bench_hw.errors import TableError

_DELIMITERS = (",", ";", "\t", "|")


@dataclass(frozen=True)
class ForeignFormat:
    """How a foreign file is laid out.

    Parameters
    ----------
    delimiter : str
        Between cells; "" finds out which of comma, semicolon, tab and bar the header holds most.
    decimal : str
        `.` or `,`.
    encoding : str
        Of the text; a byte-order mark is taken off.
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
    decimal: str = "."
    encoding: str = "utf-8"
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
    lines = list(_numbered_lines(path, layout))
    first = lines[0][1] if lines else ""
    if not first:
        raise TableError(path, "the file is empty", "a header and rows of numbers")
    delimiter = layout.delimiter or max(_DELIMITERS, key=first.count)
    names: Sequence[str] = ()
    if layout.header:
        names = _cells(path, *lines[0], delimiter)
        lines = lines[1:]
    lines = lines[layout.skip_rows :]
    rows = [_cells(path, number, line, delimiter) for number, line in lines]
    if layout.decimal == ",":
        rows = [[cell.replace(",", ".") for cell in row] for row in rows]
    return ForeignRows(path, tuple(names), tuple(rows), tuple(number for number, _ in lines))


def _numbered_lines(path: Path, layout: ForeignFormat) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(_text(path, layout.encoding).splitlines(), start=1):
        commented = layout.comment and line.startswith(layout.comment)
        if number > layout.skip_lines and line.strip() and not commented:
            yield number, line


def _text(path: Path, encoding: str) -> str:
    try:
        return path.read_bytes().decode(encoding).removeprefix("\ufeff")
    except OSError as error:
        problem = f"the file cannot be read ({error.strerror})"
        raise TableError(path, problem, "the path of a readable CSV file") from error
    except (LookupError, UnicodeDecodeError) as error:
        problem = f"the file is no {encoding} text ({error})"
        raise TableError(path, problem, "another encoding, for instance latin-1 or utf-16") from error


def _cells(path: Path, number: int, line: str, delimiter: str) -> list[str]:
    try:
        cells = next(csv.reader(io.StringIO(line, newline=""), delimiter=delimiter, strict=True))
    except csv.Error as error:
        problem = f"the row cannot be split ({error})"
        raise TableError(path, problem, f"cells separated by {delimiter!r}", row=number) from error
    return [cell.strip() for cell in cells]
