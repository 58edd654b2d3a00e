"""The CSV tables of a finished run, read back."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmark.errors import InputError
from benchmark.models import Array
from benchmark.runs.report.run_page import DESCRIPTIONS

MM = 1e-3
"""A column in mm times this is in m."""


def _place(path: Path) -> tuple[int, str]:
    """Where a table stands among those of a run."""
    known = list(DESCRIPTIONS)
    return known.index(path.name) if path.name in known else len(known), path.name


@dataclass(frozen=True)
class Table:
    """A table: where it is, and its cells as text by column."""

    path: Path
    columns: dict[str, list[str]]

    def words(self, name: str) -> list[str]:
        """A column as text; InputError where there is none of this name."""
        if name not in self.columns:
            raise InputError(f"{self.path}: there is no column {name!r}; it has {', '.join(self.columns)}")
        return self.columns[name]

    def numbers(self, name: str) -> Array:
        """A column as numbers (n,), NaN for an empty cell."""
        cells = self.words(name)
        try:
            return np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError as error:
            raise InputError(f"{self.path}, column {name}: {error}; allowed: numbers and empty cells") from None

    def plain(self) -> dict[str, list[int | float | str | None]]:
        """All columns, each cell as the number or text it is."""
        return {name: [_plain(cell) for cell in cells] for name, cells in self.columns.items()}


def _plain(cell: str) -> int | float | str | None:
    """A cell as the number or text it is."""
    if not cell:
        return None
    for kind in (int, float):
        try:
            return kind(cell)
        except ValueError:
            continue
    return cell


class SavedTables:
    """The folder `tables` of a run."""

    def __init__(self, folder: Path):
        self._folder = folder / "tables"

    def has(self, name: str) -> bool:
        """Whether the run has a table of this name."""
        return (self._folder / name).is_file()

    def read(self, name: str) -> Table:
        """Read a table; InputError where it is missing or ragged."""
        path = self._folder / name
        try:
            rows = list(csv.reader(io.StringIO(path.read_text(encoding="utf-8"))))
        except OSError as error:
            raise InputError(f"{path} cannot be read ({error}); needed: the result folder of a run") from None
        head, *body = rows or [[]]
        if not head or any(len(row) != len(head) for row in body):
            raise InputError(f"{path}: its rows are not all as long as its first one")
        return Table(path, {name: [row[place] for row in body] for place, name in enumerate(head)})

    def texts(self) -> dict[str, str]:
        """The text of every table by file name."""
        return {path.name: path.read_text(encoding="utf-8") for path in sorted(self._folder.glob("*.csv"), key=_place)}
