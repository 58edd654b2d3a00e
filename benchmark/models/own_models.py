"""A user's own FEA in the FEM's place: a table of deflections with the columns of `max_deformation.csv`."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench_hw.errors import TableError
from bench_hw.storage.regular_file import TABLE, read_regular
from bench_hw.tables.columns import numbers_of, read_source, text_columns
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.model_file import RepairedModel
from benchmark.models.model_result import Array, Drive, ModelResult, profile_radii
from benchmark.models.prepare import scenario_drive
from benchmark.models.user_file import UserFile

COLUMNS = ("step", "time_s", "force_N", "layer", "fem_mm")
TOLERANCE = 1e-4
"""How far times and loads of the table may be from the scenario's, as a part of their largest."""

EMPTY = "a table has no profile and no compute time: the profile, timing and speed-up of the FEM are empty"


@dataclass(frozen=True)
class Reference:
    """A user's own FEA: what reports call it, and its values as a model's."""

    name: str
    result: ModelResult


@dataclass(frozen=True)
class _Rows:
    """The table row by row, (k,) each: step, time in s, force in N, layer, deflection in m, line of the file."""

    path: Path
    step: Array
    time: Array
    force: Array
    layer: tuple[str, ...]
    deflection: Array
    line: tuple[int, ...]


def read_reference(path: Path, scenario: Scenario) -> Reference:
    """Read the FEA of a scenario.

    Parameters
    ----------
    path : Path
        A CSV file with the columns `step, time_s, force_N, layer, fem_mm`, more are allowed: one row for each step
        (from 1) and layer, `fem_mm` the deflection of the layer's top face on the tool axis, press positive.
    scenario : Scenario
        What it is the FEA of: its layers, and the times and loads of its steps.

    Raises
    ------
    InputError
        File, line and column: a column or a cell that is missing or no number, layers or steps that differ from the
        scenario's.
    """
    rows = _read(path)
    drive, names = scenario_drive(scenario), scenario.tissue.layer_names
    _check_layers(rows, names)
    places = _places(rows, drive.time.size, names)
    _check_history(rows, drive)
    top = rows.deflection[places]
    force = rows.force[places[:, 0]]
    peak = int(np.abs(drive.value).argmax())
    radii = profile_radii(scenario.tool.radius)
    result = ModelResult(
        model="fem",
        layers=names,
        time=drive.time,
        force=force,
        depth=drive.value if drive.control == "depth" else top[:, 0],
        top_deflection=top,
        profile_radii=radii,
        profile=np.full((len(names), radii.size), np.nan),
        peak_step=peak,
        unknowns=None,
        notes={
            "model": f"the user's own FEA, {path}",
            "SHA-256 of the file": hashlib.sha256(read_regular(path, TABLE)).hexdigest(),
        },
        warnings=(EMPTY,),
    )
    return Reference(f"FEA of {path.name}", result)


def _read(path: Path) -> _Rows:
    """The columns as numbers, SI."""
    try:
        source = read_source(path, COLUMNS)
        columns, lines = text_columns(source)
        cells = dict(zip(source.names, columns, strict=True))
        at = np.array(lines, dtype=np.int64)
        step, time, force, deflection = (
            numbers_of(path, name, cells[name], at, empty=False) for name in COLUMNS if name != "layer"
        )
    except TableError as error:
        raise InputError(f"{error}") from None
    if not lines:
        raise InputError(f"{path}: the table has no rows; needed: one for each step and layer")
    return _Rows(path, step, time, force, cells["layer"], 1e-3 * deflection, tuple(lines))


def _check_layers(rows: _Rows, names: tuple[str, ...]) -> None:
    """Refuse layers that are not the scenario's."""
    found = tuple(dict.fromkeys(rows.layer))
    if set(found) != set(names):
        raise InputError(
            f"{rows.path}, column layer: the table has the layers {', '.join(found)}, "
            f"the scenario {', '.join(names)}; they must be the same"
        )


def _places(rows: _Rows, steps: int, names: tuple[str, ...]) -> np.ndarray[tuple[int, int], np.dtype[np.int64]]:
    """(n, L) row of each step and layer; refuses steps that are not 1..n, once each."""
    places = np.full((steps, len(names)), -1, dtype=np.int64)
    for row, (step, layer) in enumerate(zip(rows.step, rows.layer, strict=True)):
        where = f"{rows.path}, line {rows.line[row]}, column step"
        if step not in range(1, steps + 1):
            raise InputError(f"{where}: the step is {step:g}; the scenario has the steps 1 to {steps}")
        place = int(step) - 1, names.index(layer)
        if places[place] >= 0:
            raise InputError(f"{where}: step {step:g} of {layer} is there twice; allowed: once for each layer")
        places[place] = row
    missing = np.argwhere(places < 0)
    if missing.size:
        step, layer = int(missing[0][0]) + 1, names[missing[0][1]]
        raise InputError(f"{rows.path}: step {step} of {layer} is missing; the scenario has the steps 1 to {steps}")
    return places


def _check_history(rows: _Rows, drive: Drive) -> None:
    """Refuse times, and loads under force control, that are not the scenario's."""
    wanted = [("time_s", "s", rows.time, drive.time)]
    if drive.control == "force":
        wanted.append(("force_N", "N", rows.force, drive.value))
    step = rows.step.astype(np.int64) - 1
    for column, unit, found, expected in wanted:
        apart = np.abs(found - expected[step]) > TOLERANCE * np.abs(expected).max()
        if apart.any():
            row = int(apart.argmax())
            raise InputError(
                f"{rows.path}, line {rows.line[row]}, column {column}: step {step[row] + 1} is at {found[row]:.6g} "
                f"{unit}, in the scenario at {expected[step[row]]:.6g} {unit}"
            )


@dataclass(frozen=True)
class Own:
    """A user's own fast model in the wave's place and own FEA in the FEM's; None keeps the model of the harness.

    `repair` switches the effects of a model file on, in both models of the harness.
    """

    wave: UserFile | None = None
    reference: Reference | None = None
    repair: RepairedModel | None = None

    def place(self, model: str) -> UserFile | RepairedModel | None:
        """What a process of `"fem"` or `"wave"` needs to know of it."""
        return self.wave if model == "wave" and self.wave is not None else self.repair

    def name(self, model: str) -> str | None:
        """What the user calls the model in the place of `"fem"` or `"wave"`; None where there is none."""
        if model == "fem":
            return None if self.reference is None else self.reference.name
        return None if self.wave is None else self.wave.name


NOTHING = Own()
