"""A user's own FEA as a table: its rows, and the deflections that it has at a scenario's steps.

Rows are either those of the scenario's steps (column `step`), or of an FEA's own output, which is then interpolated
over its time, or over its load where it has no time; one row a layer is the peak load alone.
"""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from bench_hw.errors import TableError
from bench_hw.instrument_files.text_sheet import number_text
from bench_hw.storage.regular_file import TABLE, open_regular, read_regular
from bench_hw.tables.columns import numbers_of, read_source, text_columns
from benchmark.errors import InputError
from benchmark.models.model_result import Array, Drive

NEEDED = ("layer", "fem_mm")
_LONGEST_HEADER = 10_000
_TOLD_SIGN = re.compile(r'"?sep=.?"?')
_DECIMAL = re.compile(r"[+-]?\d*([.,])\d+(?:[eE][+-]?\d+)?", re.ASCII)
_TWO_BYTES = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
NUMBERS: tuple[str, ...] = ("step", "time_s", "force_N", "depth_mm", "radius_mm", "fem_mm")
LOADS = {"force": ("force_N", 1.0), "depth": ("depth_mm", 1e-3)}
"""Column of what is prescribed, and its size in SI, by the scenario's control."""
TOLERANCE = 1e-4
"""How far times and loads of a scenario's steps may be from the scenario's, as a part of their largest."""
SAME_LOAD = 1e-2
"""The same for an FEA's own history at the scenario's times."""
NARROW, WIDE = 0.1, 500.0
"""A profile ends beyond this share of the tool's radius, and within this multiple of the set-up's widest one."""
Places: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class ReferenceRows:
    """The table row by row: `columns` of (k,) numbers as they stand in the file, layer and line of the file."""

    path: Path
    columns: Mapping[str, Array]
    layer: tuple[str, ...]
    line: Places

    def where(self, row: int, column: str) -> str:
        """A place for messages."""
        return f"{self.path}, line {int(self.line[row])}, column {column}"

    def chosen(self, mask: NDArray[np.bool_]) -> ReferenceRows:
        """Some of the rows."""
        layer = tuple(name for name, use in zip(self.layer, mask, strict=True) if use)
        return ReferenceRows(self.path, {key: each[mask] for key, each in self.columns.items()}, layer, self.line[mask])

    def of_layer(self, name: str) -> NDArray[np.bool_]:
        """(k,) whether a row is of this layer."""
        return np.array([each == name for each in self.layer], dtype=bool)


@dataclass(frozen=True, eq=False)
class ReferenceHistory:
    """Deflections (n, L) in m and forces (n,) in N at a scenario's steps; `how` they were got, "" for as they stand."""

    top: Array
    force: Array
    how: str


def header_sign(path: Path) -> str | None:
    """What stands between the names of a table's header: a comma, a semicolon or a tab; None of what is no table."""
    try:
        with open_regular(path, TABLE) as stream:
            head = stream.read(_LONGEST_HEADER)
    except OSError:
        return None
    names = next(iter(_lines(head).values()), "")
    signs = (sign for sign in ",;\t" if set(NEEDED) <= {name.strip(' "') for name in names.split(sign)})
    return next(signs, None)


def _lines(data: bytes) -> dict[int, str]:
    """The lines of a spreadsheet's text by their numbers, without blank ones, and without `sep=;` above the header."""
    try:
        text = data.decode("utf-16" if data.startswith(_TWO_BYTES) else "utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("cp1252", errors="replace")
    numbered = enumerate(text.splitlines(), start=1)
    return {number: line for number, line in numbered if line.strip(' ;,\t"') and not _TOLD_SIGN.fullmatch(line)}


def _cells(path: Path) -> tuple[dict[str, tuple[str, ...]], Places]:
    """The cells (k,) of each column, and the lines of the file; raises TableError.

    A table with commas between its cells is read strictly, with semicolons or tabs as spreadsheets write it: with
    decimal commas, too, in UTF-16 and cp1252, and with empty rows.
    """
    sign = header_sign(path)
    if sign in (None, ","):
        source = read_source(path, NEEDED)
        columns, lines = text_columns(source)
        return dict(zip(source.names, columns, strict=True)), np.array(lines, dtype=np.int64)
    written = _lines(read_regular(path, TABLE))
    records = [[cell.strip() for cell in row] for row in csv.reader(written.values(), delimiter=str(sign))]
    names, rows, at = records[0], records[1:], list(written)[1:]
    for line, row in zip(at, rows, strict=False):
        if len(row) != len(names):
            raise TableError(path, f"the row has {len(row)} cells", f"{len(names)} cells, as in the header", row=line)
    decimal = _decimal(path, rows, at)
    columns = [tuple(number_text(row[k], decimal) for row in rows) for k in range(len(names))]
    return dict(zip(names, columns, strict=True)), np.array(at, dtype=np.int64)


def _decimal(path: Path, rows: list[list[str]], lines: list[int]) -> str:
    """The decimal sign of a spreadsheet's numbers; raises TableError where both signs are there."""
    found: dict[str, tuple[int, str]] = {}
    for line, row in zip(lines, rows, strict=False):
        marked = (mark for cell in row if (mark := _DECIMAL.fullmatch(cell)))
        found |= {mark[1]: (line, mark[0]) for mark in marked if mark[1] not in found}
    if len(found) == 2:
        (line, cell), (other, first) = found[","], found["."]
        problem = f"the comma in numbers, where line {other} has a point in {first!r}"
        raise TableError(path, problem, "one decimal sign in a table", row=line, value=cell)
    return next(iter(found), ".")


def read_rows(path: Path) -> ReferenceRows:
    """The columns as numbers; empty cells only in `radius_mm`, and in steps, times and loads beside a radius above 0.

    Raises
    ------
    InputError
        File, line and column of what is missing or no number.
    """
    try:
        cells, at = _cells(path)
        known = [name for name in NUMBERS if name in cells]
        columns: dict[str, Array] = {
            name: numbers_of(path, name, cells[name], at, empty=name != "fem_mm") for name in known
        }
        _check_empty(path, columns, at)
    except TableError as error:
        raise InputError(f"{error}") from None
    if not at.size:
        raise InputError(f"{path}: the table has no rows; needed: one for each step and layer")
    return ReferenceRows(path, columns, cells["layer"], at)


def _check_empty(path: Path, columns: Mapping[str, Array], lines: Places) -> None:
    """Refuse an empty step, time or load of a row on the axis; rows of the profile may leave them out."""
    off = _off(columns, lines.size)
    for name, column in columns.items():
        empty = np.flatnonzero(np.isnan(column) & ~off)
        if empty.size and name != "radius_mm":
            raise TableError(
                path, "the cell is empty", "a finite number", row=int(lines[empty[0]]), column=name, value=""
            )


def _off(columns: Mapping[str, Array], count: int) -> NDArray[np.bool_]:
    """(k,) whether a row is off the axis: its `radius_mm` is there and not 0."""
    return np.asarray(np.nan_to_num(columns.get("radius_mm", np.zeros(count))) != 0.0)


def parted(rows: ReferenceRows) -> tuple[ReferenceRows, ReferenceRows]:
    """Rows on the axis, and those of the profile at peak load, which have a `radius_mm` above 0."""
    off = _off(rows.columns, rows.line.size)
    return rows.chosen(~off), rows.chosen(off)


def check_layers(rows: ReferenceRows, names: tuple[str, ...]) -> None:
    """Refuse layers that are not the scenario's."""
    found = tuple(dict.fromkeys(rows.layer))
    if set(found) != set(names):
        raise InputError(
            f"{rows.path}, column layer: the table has the layers {', '.join(found)}, "
            f"the scenario {', '.join(names)}; they must be the same"
        )


def history(rows: ReferenceRows, drive: Drive, names: tuple[str, ...]) -> ReferenceHistory:
    """What the table has at the scenario's steps.

    Raises
    ------
    InputError
        Steps, times or loads that are not the scenario's, a table that ends before it, or one without any of them.
    """
    if rows.line.size == len(names) and drive.time.size > 1:
        return _peak_alone(rows, drive, names)
    if "step" in rows.columns:
        return _by_step(rows, drive, names)
    over = "time_s" if "time_s" in rows.columns else LOADS[drive.control][0]
    if over not in rows.columns:
        raise InputError(
            f"{rows.path}: needed is one of the columns step (the scenario's steps), time_s, or {over} (a load that "
            "rises); the values are taken at the scenario's steps by it"
        )
    return _interpolated(rows, drive, names, over)


def _peak_alone(rows: ReferenceRows, drive: Drive, names: tuple[str, ...]) -> ReferenceHistory:
    """The one row of each layer at the largest load; the other steps have no deflection (NaN)."""
    peak = int(np.abs(drive.value).argmax())
    check_at_peak(rows, drive, "with one row a layer; that is the peak load alone")
    top = np.full((drive.time.size, len(names)), np.nan)
    top[peak] = [1e-3 * float(rows.columns["fem_mm"][rows.of_layer(name)][0]) for name in names]
    force = drive.value
    if drive.control == "depth":
        if "force_N" not in rows.columns:
            raise InputError(f"{rows.path}: the column force_N is missing; under depth control it is the answer")
        force = np.where(np.arange(force.size) == peak, rows.columns["force_N"][rows.of_layer(names[0])][0], np.nan)
    return ReferenceHistory(top, force, "the peak load alone, one row a layer: nothing at the other steps")


def check_at_peak(rows: ReferenceRows, drive: Drive, what: str, *, unsaid: float = np.nan) -> None:
    """Refuse rows of another step or load than the peak's; a time counts where neither is told (a static FEA has any).

    `what` says in words which rows are those of the peak. A cell that is empty or `unsaid` tells nothing.
    """
    peak, (column, size) = int(np.abs(drive.value).argmax()), LOADS[drive.control]
    expected = {"step": (peak + 1.0, 0.0), column: (drive.value[peak] / size, SAME_LOAD)}
    if not expected.keys() & rows.columns.keys():
        expected = {"time_s": (drive.time[peak], SAME_LOAD)}
    for name, (value, share) in expected.items():
        found = rows.columns.get(name, np.full(rows.line.size, value))
        apart = (np.abs(found - value) > share * abs(value)) & (found != unsaid)
        if apart.any():
            near = f", to {100 * share:g} %" if share else ""
            raise InputError(
                f"{rows.where(int(apart.argmax()), name)}: {found[apart][0]:.6g}, {what}, allowed: {value:.6g}{near}. "
                "Other steps need a row of their own"
            )


def _by_step(rows: ReferenceRows, drive: Drive, names: tuple[str, ...]) -> ReferenceHistory:
    places = _places(rows, drive.time.size, names)
    for column in ("time_s", "force_N"):
        if column not in rows.columns:
            raise InputError(f"{rows.path}: the column {column} is missing; a table with steps needs it")
    _check_steps(rows, drive)
    return ReferenceHistory(1e-3 * rows.columns["fem_mm"][places], _one_force(rows, places), "")


def _one_force(rows: ReferenceRows, places: Places) -> Array:
    """(n,) N of the steps; refuses layers that are told of different forces at the same step."""
    force = rows.columns["force_N"][places]
    apart = np.argwhere(np.abs(force - force[:, :1]) > TOLERANCE * np.abs(force).max())
    if apart.size:
        step, layer = (int(each) for each in apart[0])
        raise InputError(
            f"{rows.where(int(places[step, layer]), 'force_N')}: {force[step, layer]:.6g} N in step {step + 1}, where "
            f"{rows.layer[places[step, 0]]} has {force[step, 0]:.6g} N; allowed: one force in all layers of a step"
        )
    return force[:, 0]


def _places(rows: ReferenceRows, steps: int, names: tuple[str, ...]) -> Places:
    """(n, L) row of each step and layer; refuses steps that are not 1..n, once each."""
    places = np.full((steps, len(names)), -1, dtype=np.int64)
    for row, (step, layer) in enumerate(zip(rows.columns["step"], rows.layer, strict=True)):
        where = rows.where(row, "step")
        if step not in range(1, steps + 1):
            raise InputError(
                f"{where}: the step is {step:g}; the scenario has the steps 1 to {steps}. Without the column step, "
                "the table is interpolated over its time_s"
            )
        place = int(step) - 1, names.index(layer)
        if places[place] >= 0:
            raise InputError(f"{where}: step {step:g} of {layer} is there twice; allowed: once for each layer")
        places[place] = row
    missing = np.argwhere(places < 0)
    if missing.size:
        step, layer = int(missing[0][0]) + 1, names[missing[0][1]]
        raise InputError(f"{rows.path}: step {step} of {layer} is missing; the scenario has the steps 1 to {steps}")
    return places


def _check_steps(rows: ReferenceRows, drive: Drive) -> None:
    """Refuse times and loads of steps that are not the scenario's."""
    column, size = LOADS[drive.control]
    wanted = [("time_s", "s", drive.time)]
    if column in rows.columns:
        wanted.append((column, column.rpartition("_")[2], drive.value / size))
    step = rows.columns["step"].astype(np.int64) - 1
    for column, unit, expected in wanted:
        found = rows.columns[column]
        apart = np.abs(found - expected[step]) > TOLERANCE * np.abs(expected).max()
        if apart.any():
            row = int(apart.argmax())
            raise InputError(
                f"{rows.where(row, column)}: step {step[row] + 1} is at {found[row]:.6g} {unit}, in the scenario at "
                f"{expected[step[row]]:.6g} {unit}. Without the column step, the table is interpolated"
            )


def _interpolated(rows: ReferenceRows, drive: Drive, names: tuple[str, ...], over: str) -> ReferenceHistory:
    column, size = LOADS[drive.control]
    at = drive.time if over == "time_s" else np.abs(drive.value) / size
    if over != "time_s":
        _check_one_way(rows, names, over)
    curves = [_curve(rows, name, over, "fem_mm", at) for name in names]
    if over == "time_s" and column in rows.columns:
        for name in names:
            _check_load(rows, name, size * _curve(rows, name, over, column, at), drive)
    counted = f"{int(rows.of_layer(names[0]).sum())} rows a layer, interpolated over {over}"
    how = counted if over == "time_s" else f"{counted}: one value a load, so nothing that depends on time"
    return ReferenceHistory(1e-3 * np.column_stack(curves), _forces(rows, drive, names[0], over, at), how)


def _check_one_way(rows: ReferenceRows, names: tuple[str, ...], over: str) -> None:
    """Refuse a load that first rises and then falls, row by row: sorted by load, both ways would be taken for one."""
    for name in names:
        mine = np.flatnonzero(rows.of_layer(name))
        load = np.abs(rows.columns[over][mine])
        top = int(load.argmax())
        if 0 < top < load.size - 1 and (np.diff(load[: top + 1]) > 0.0).all() and (np.diff(load[top:]) < 0.0).all():
            raise InputError(
                f"{rows.where(int(mine[top + 1]), over)}: the load of {name} falls here after it has risen; without "
                "time_s the table is a curve over a rising load. Leave the way back out, or give time_s"
            )


def _forces(rows: ReferenceRows, drive: Drive, layer: str, over: str, at: Array) -> Array:
    if drive.control == "force":
        return drive.value
    if "force_N" not in rows.columns:
        raise InputError(f"{rows.path}: the column force_N is missing; under depth control it is the answer")
    return _curve(rows, layer, over, "force_N", at)


def _curve(rows: ReferenceRows, layer: str, over: str, column: str, at: Array) -> Array:
    """(n,) values of a column of one layer at places (n,) of `over`, from rest: without overshoot between the rows."""
    mine = np.flatnonzero(rows.of_layer(layer))
    mine = mine[np.argsort(rows.columns[over][mine], kind="stable")]
    x, y = rows.columns[over][mine], rows.columns[column][mine]
    same = np.flatnonzero(np.diff(x) <= 0.0)
    if same.size:
        row = int(mine[same[0] + 1])
        raise InputError(f"{rows.where(row, over)}: {x[same[0]]:g} is there twice for {layer}; allowed: once for each")
    if x[0] > 0.0:
        x, y = np.concatenate([[0.0], x]), np.concatenate([[0.0], y])
    if x.size < 2 or at.max() > x[-1] * (1.0 + TOLERANCE) or at.min() < x[0]:
        raise InputError(
            f"{rows.path}, column {over}: {layer} goes from {x[0]:g} to {x[-1]:g}, the scenario's steps from "
            f"{at.min():g} to {at.max():g}; the table must reach as far"
        )
    return _between_turns(x, y, np.minimum(at, x[-1]))


def _between_turns(x: Array, y: Array, at: Array) -> Array:
    """Monotone cubic interpolation of y (k,), each rise, hold and fall by itself, so that its corners stay sharp."""
    way = np.sign(np.diff(y))
    turns = [0, *(np.flatnonzero(np.diff(way) != 0.0) + 1).tolist(), x.size - 1]
    out = np.interp(at, x, y)
    for first, last in pairwise(turns):
        inside = (at >= x[first]) & (at <= x[last])
        if last - first > 1:
            out[inside] = PchipInterpolator(x[first : last + 1], y[first : last + 1])(at[inside])
    return np.asarray(out)


def _check_load(rows: ReferenceRows, layer: str, found: Array, drive: Drive) -> None:
    """Refuse a layer's rows under another load history."""
    apart = np.abs(found - drive.value) / np.abs(drive.value).max()
    if apart.max() > SAME_LOAD:
        step = int(apart.argmax())
        column, size = LOADS[drive.control]
        raise InputError(
            f"{rows.path}, column {column}: at {drive.time[step]:g} s {layer} is at {found[step] / size:.4g}, the "
            f"scenario at {drive.value[step] / size:.4g}; they must press alike, to {100 * SAME_LOAD:g} % of the peak"
        )


def check_radii(rows: ReferenceRows, tool: float, widest: float) -> None:
    """Refuse a profile whose radii are of another size than the tool's (m) and the set-up's widest radius (m).

    One that ends within a tenth of the tool shows nothing of it, and none goes hundreds of times as far as all else.
    """
    radii = np.abs(rows.columns["radius_mm"]) if "radius_mm" in rows.columns else np.zeros(0)
    if not radii.size:
        return
    row = int(radii.argmax())
    if not NARROW * tool <= 1e-3 * radii[row] <= WIDE * widest:
        raise InputError(
            f"{rows.where(row, 'radius_mm')}: the profile ends at {radii[row]:.6g} mm, where the tool has a radius of "
            f"{1e3 * tool:.6g} mm; allowed: {1e3 * NARROW * tool:.6g} to {1e3 * WIDE * widest:.6g} mm. Is it in "
            f"{'m' if 1e-3 * radii[row] < NARROW * tool else 'um'}?"
        )


def profile(rows: ReferenceRows, names: tuple[str, ...], radii: Array, axis: Array) -> Array:
    """(L, m) deflections in m at the peak load and radii (m,), m; NaN beyond the rows, and of a layer without any.

    `axis` (L,) m are the deflections on the axis.
    """
    out = np.full((len(names), radii.size), np.nan)
    for number, name, mine in _off_axis(rows, names):
        x = np.concatenate([[0.0], 1e-3 * rows.columns["radius_mm"][mine]])
        y = np.concatenate([[axis[number]], 1e-3 * rows.columns["fem_mm"][mine]])
        if (np.diff(x) <= 0.0).any():
            row = int(mine[np.flatnonzero(np.diff(x) <= 0.0)[0]])
            raise InputError(f"{rows.where(row, 'radius_mm')}: a radius of {name} twice, or below 0; allowed: once")
        inside = radii <= x[-1] * (1.0 + 1e-9)
        out[number, inside] = PchipInterpolator(x, y)(np.minimum(radii[inside], x[-1]))
    return out


def _off_axis(rows: ReferenceRows, names: tuple[str, ...]) -> Iterator[tuple[int, str, Places]]:
    """Number, name and rows by radius of each layer that has a profile."""
    for number, name in enumerate(names):
        mine = np.flatnonzero(rows.of_layer(name))
        if mine.size:
            yield number, name, mine[np.argsort(rows.columns["radius_mm"][mine], kind="stable")]


def template(drive: Drive, names: tuple[str, ...]) -> dict[str, list[float | int | str | None]]:
    """The columns of a table for a scenario's steps, deflections left empty; forces, too, under depth control."""
    steps = [(step, layer) for step in range(drive.time.size) for layer in names]
    force = drive.control == "force"
    table: dict[str, list[float | int | str | None]] = {
        "step": [step + 1 for step, _ in steps],
        "time_s": [float(drive.time[step]) for step, _ in steps],
        "force_N": [float(drive.value[step]) if force else None for step, _ in steps],
    }
    if not force:
        table["depth_mm"] = [1e3 * float(drive.value[step]) for step, _ in steps]
    return {**table, "layer": [layer for _, layer in steps], "fem_mm": [None] * len(steps)}
