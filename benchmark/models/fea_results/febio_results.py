"""Results of FEBio: its log, or a file of data records, of an exported file or of nodes with `x;y;z;ux;uy;uz`.

A record is headed by `Step`, `Time` and `Data` (with an asterisk in a file of its own); rows are an item's number and
its values. Of an exported file the name of the data tells what it is (`benchmark.exchange.febio_file`); of another the
nodes that were on the axis (z, the surface at its top) at each layer's top face are taken. Written after FEBio's
documentation and source, and tried on texts in that form, not on FEBio's own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models.fea_results.solver_history import (
    SAME_PLACE,
    SolverHistory,
    layer_at,
    layer_number,
    number,
    text_of,
)
from benchmark.models.reference_table import ReferenceRows

HEAD = re.compile(r"^\*?(Step|Time|Data)\s*=\s*(.*?)\s*$")
ROW = re.compile(r"^\s*\d+[\s,;]")
PLACES = ("x", "y", "z", "ux", "uy", "uz")
SHARES = {"TOOL": 1.0, "TOOL_QUARTER": 4.0}


@dataclass(frozen=True, eq=False)
class _Record:
    """Instant, what the record is called, its columns, rows of (item, values), and the line of its heading."""

    time: float
    name: str
    columns: tuple[str, ...]
    rows: list[tuple[int, list[float]]]
    line: int


def read_febio(path: Path, scenario: Scenario) -> ReferenceRows:
    """Rows from the records of a log or data file.

    Raises
    ------
    InputError
        File and line of what cannot be read, or what is missing.
    """
    lines, found = text_of(path), SolverHistory(path, scenario.tissue.layer_names)
    thickness = {one.name: one.thickness for one in scenario.tissue.layers}
    for record in _records(path, lines):
        if record.name.startswith("AXIS_"):
            layer = layer_number(path, record.line, record.name.removeprefix("AXIS_"), found.layers)
            found.add(record.time, layer, -_value(path, record, "uz"), record.line + 2)
        elif record.name in SHARES:
            found.force[record.time] = abs(SHARES[record.name] * _value(path, record, "Fz"))
        elif not record.name and set(PLACES) <= set(record.columns):
            _by_place(found, record, thickness)
    return found.rows()


def _value(path: Path, record: _Record, column: str) -> float:
    """A value of a record of one item."""
    if column not in record.columns or len(record.rows) != 1:
        raise InputError(
            f"{path}, line {record.line + 1}: {record.name} must have one row with {column}, it has {len(record.rows)} "
            f"rows of {';'.join(record.columns)[:60]}"
        )
    return record.rows[0][1][record.columns.index(column)]


def _by_place(found: SolverHistory, record: _Record, thickness: dict[str, float]) -> None:
    """Nodes on the axis at the layers' top faces, by where they were at rest."""
    if not record.rows:
        return
    table = np.array([values for _, values in record.rows])
    at = {name: table[:, record.columns.index(name)] for name in PLACES}
    rest = {axis: at[axis] - at[f"u{axis}"] for axis in "xyz"}
    radius = np.hypot(rest["x"], rest["y"])
    layer = layer_at(rest["z"].max() - rest["z"], thickness)
    size = max(float(radius.max()), sum(thickness.values()))
    for k in np.flatnonzero((radius <= SAME_PLACE * size) & (layer >= 0)):
        found.add(record.time, int(layer[k]), -float(at["uz"][k]), record.line + 2)


def _records(path: Path, lines: list[str]) -> Iterator[_Record]:
    """Records with their instants."""
    time: float | None = None
    for at, line in enumerate(lines):
        head = HEAD.match(line)
        if head is None or head[1] == "Step":
            continue
        if head[1] == "Time":
            time = number(path, at, head[2])
        elif time is not None:
            name, _, columns = head[2].rpartition(":")
            names = tuple(each.strip() for each in columns.split(";"))
            yield _Record(time, name.strip().upper(), names, list(_rows(path, lines, at, len(names))), at)


def _rows(path: Path, lines: list[str], at: int, count: int) -> Iterator[tuple[int, list[float]]]:
    """Rows after a heading, up to the next line that is none; a file's name may stand between."""
    for row in range(at + 1, len(lines)):
        if row == at + 1 and lines[row].startswith("File"):
            continue
        if not ROW.match(lines[row]):
            return
        words = re.split(r"[\s,;]+", lines[row].strip())
        if len(words) != count + 1:
            raise InputError(
                f"{path}, line {row + 1}: {len(words) - 1} values where {count} are announced; the file is damaged"
            )
        yield int(number(path, row, words[0])), [number(path, row, word) for word in words[1:]]
