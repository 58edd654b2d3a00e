"""The CSV tables of a finished run read back, and its trials in them."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmark.errors import InputError
from benchmark.identification import FittedParameter
from benchmark.models import Array
from benchmark.runs.report.film_section import read_film
from benchmark.runs.report.run_page import DESCRIPTIONS
from benchmark.runs.report.trials_section import TrialsPart
from benchmark.runs.trials.measured import TrialPrediction
from reports.tables import read_cell

FROM_MM = 1e-3
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
        except (OSError, ValueError, csv.Error) as error:
            raise InputError(f"{path} cannot be read ({error}); needed: the result folder of a run") from None
        head, *body = rows or [[]]
        if not head or any(len(row) != len(head) for row in body):
            raise InputError(f"{path}: its rows are not all as long as its first one")
        return Table(path, {read_cell(name): [read_cell(row[k]) for row in body] for k, name in enumerate(head)})

    def texts(self) -> dict[str, str]:
        """The text of every table by file name."""
        return {path.name: path.read_text(encoding="utf-8") for path in sorted(self._folder.glob("*.csv"), key=_place)}


NUMBERS = ("value", "ci95_low", "ci95_high")


def saved_trials(document: dict[str, Any], tables: SavedTables, markers: Path) -> TrialsPart:
    """Return the trials of a run; the forces held out are in no table, so they are not there.

    Parameters
    ----------
    document
        Content of `results.json`.
    tables
        Of the run.
    markers
        The folder of what is shown of films, which need not be there.

    Raises
    ------
    InputError
        A table that is missing or cannot be read.
    """
    told = document["trials"]
    return TrialsPart(
        trials=_predictions(tables.read("measured.csv")),
        synthetic=bool(told["synthetic"]),
        headline=str(told["headline"]),
        parameters=_parameters(tables.read("fitted_parameters.csv")),
        notes=tuple(told["notes"]),
        markers=read_film(markers),
    )


def _predictions(table: Table) -> tuple[TrialPrediction, ...]:
    keys = list(zip(table.words("trial"), table.words("condition"), strict=True))
    time, depth, force, fem, wave = (
        table.numbers(name) for name in ("time_s", "depth_mm", "force_N", "fem_force_N", "wave_force_N")
    )
    found = []
    for key in dict.fromkeys(keys):
        rows = np.array([each == key for each in keys])
        answered = bool(np.isfinite(wave[rows]).any())
        found.append(
            TrialPrediction(
                trial=key[0],
                condition=key[1],
                time=time[rows],
                depth=FROM_MM * depth[rows],
                force=force[rows],
                fem_force=fem[rows],
                wave_force=wave[rows] if answered else None,
                held_out_force=None,
            )
        )
    return tuple(found)


def _parameters(table: Table) -> tuple[FittedParameter, ...]:
    numbers = [[None if np.isnan(value) else float(value) for value in table.numbers(name)] for name in NUMBERS]
    words = [table.words(name) for name in ("name", "unit", "source")]
    known = [word == "true" for word in table.words("identifiable")]
    ends = [ends if told else (None, None) for told, *ends in zip(known, *numbers[1:], strict=True)]  # as once written
    return tuple(
        FittedParameter(name, value, unit, low, high, told, source)
        for name, unit, source, value, told, (low, high) in zip(*words, numbers[0], known, ends, strict=True)
    )
