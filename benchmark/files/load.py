"""The load of a scenario: how high, how long, in what shape, and the rows of time and value that it stands for."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import field_serializer, field_validator, model_validator
from pydantic_core import PydanticCustomError
from pydantic_core.core_schema import SerializationInfo, ValidationInfo

from bench_hw.tables import TableError
from bench_hw.tables.columns import check_increasing, read_columns, read_source
from bench_hw.tables.units import to_si
from benchmark.errors import InputError
from benchmark.files import units
from benchmark.files.quantities import Bounds, Duration, Number, Quantity, problem, quantity, shortened
from benchmark.files.schema import FileModel
from benchmark.files.sources import folder_of
from benchmark.files.units import format_quantity, shown_quantity

Rows = tuple[tuple[float, float], ...]

LOADS: Final[dict[str, Quantity]] = {
    "force": quantity(units.FORCE, -1e9, 1e9),
    "depth": quantity(units.LENGTH, -1e3, 1e3),
}
"""What the values of a load measure under each control."""

LEAST: Final[dict[str, float]] = {"force": 1e-9, "length": 1e-12}
"""Smallest magnitudes of a peak, N and m: squares of what a smaller one moves are lost in double precision."""

_TIME = quantity(units.DURATION, 0.0, 1e7)
_COLUMNS: Final = {"force": ("force_N", "N"), "depth": ("depth_mm", "mm")}


def read_load_file(path: Path, control: str) -> Rows:
    """Read the load table of a scenario.

    Parameters
    ----------
    path : Path
        A CSV file with the columns `time_s` and `force_N` (or `depth_mm` under depth control); more are allowed.
    control : str
        "force" or "depth".

    Returns
    -------
    tuple of (time, value)
        In s and N or m.

    Raises
    ------
    InputError
        When the file or a column is missing, a cell is no finite number, or time does not increase from >= 0 s.
    """
    column, unit = _COLUMNS[control]
    try:
        columns = read_columns(read_source(path, ("time_s", column)), ("time_s", column))
        check_increasing(path, "time_s", columns.values["time_s"], columns.lines)
    except TableError as error:
        raise InputError(f"{error}.") from None
    values = to_si(columns.values[column], unit)
    rows = tuple(zip(columns.values["time_s"].tolist(), values.tolist(), strict=True))
    fault = _fault(rows)
    if fault:
        raise InputError(f"{path}: {fault}.")
    return rows


def read_rows(table: Any, control: str, info: ValidationInfo) -> Rows:
    """Read rows written in the scenario, `[["0.1 s", "1 N"], ...]`.

    Raises
    ------
    PydanticCustomError
        Naming the row, when one is not a time and a load, or when time does not increase from >= 0 s.
    """
    if not isinstance(table, list | tuple) or not all(isinstance(row, list | tuple) and len(row) == 2 for row in table):
        raise problem('it must be a list of pairs such as ["0.1 s", "1 N"]', key="table")
    rows = []
    for number, (time, value) in enumerate(table, start=1):
        try:
            rows.append((_TIME.validate(time, info) or 0.0, LOADS[control].validate(value, info) or 0.0))
        except PydanticCustomError as error:
            raise problem(f"row {number}: {error.message()}", key="table") from None
    fault = _fault(tuple(rows))
    if fault:
        raise problem(fault, key="table")
    return tuple(rows)


def _fault(rows: Rows) -> str | None:
    """What is wrong with a table as a whole."""
    times = [time for time, _ in rows]
    if not times or times[-1] <= 0 or times[0] < 0:
        return "a load table needs at least one row after 0 s and none before"
    late = next((row for row in range(1, len(times)) if times[row] <= times[row - 1]), None)
    if late is not None:
        return f"row {late + 1} is at {times[late]:g} s after {times[late - 1]:g} s; time must increase"
    return None


Control = Literal["force", "depth"]
Shape = Literal["triangle", "ramp", "ramp_hold", "table"]
Observations = Annotated[int, Number("1 to 1000000 (a whole number)", Bounds(1, 1_000_000), whole=True)]

OBSERVATIONS = 100
"""Rows of a history whose scenario does not say how many."""


class Load(FileModel):
    """A press.

    Attributes
    ----------
    control : str
        force | depth.
    peak : float
        N or m, not zero; of a table its value of largest magnitude, whatever the file says.
    shape : str
        triangle | ramp | ramp_hold | table.
    duration : float
        s; of a ramp_hold the ramp alone, of a table its last time, whatever the file says.
    observations : int or None
        Rows of the history; None for a table whose own rows they are.
    hold : float or None
        s, after the ramp of a ramp_hold; ignored by the other shapes.
    table : tuple of (time, value) or None
        Rows in s and N or m. A scenario names a CSV file with `file = "load.csv"`, whose rows come here, so that
        a resolved scenario needs no other file.
    """

    other_keys: ClassVar[tuple[str, ...]] = ("file",)

    control: Control = "force"
    peak: float
    shape: Shape = "triangle"
    duration: Duration = 10.0
    observations: Observations | None = None
    hold: Duration | None = None
    table: Rows | None = None

    @model_validator(mode="before")
    @classmethod
    def _rows_or_shape(cls, data: Any, info: ValidationInfo) -> Any:
        if not isinstance(data, Mapping):
            return data
        given = dict(data)
        file, table = given.pop("file", None), given.pop("table", None)
        if given.get("shape") != "table":
            return {"observations": OBSERVATIONS, **given}
        control = given.get("control", "force")
        if control not in LOADS:
            return {"peak": 1.0, **given}
        rows = _rows(file, table, control, info)
        peak = max((value for _, value in rows), key=abs)
        return {
            **given,
            "table": rows,
            "peak": format_quantity(peak, LOADS[control].dimension),
            "duration": format_quantity(rows[-1][0], units.DURATION),
        }

    @field_validator("peak", mode="before")
    @classmethod
    def _peak_in_its_unit(cls, value: Any, info: ValidationInfo) -> float:
        kind = LOADS[info.data.get("control", "force")]
        peak = kind.validate(value, info)
        least = LEAST[kind.dimension.name]
        if peak is None or abs(peak) < least:
            wanted = (
                f"any {kind.dimension.name} but zero, of {shown_quantity(least, kind.dimension)} or more in magnitude"
            )
            raise problem(f"{shortened(value)} is no press; allowed: {wanted}, within {kind.allowed}")
        return peak

    @field_serializer("peak", "table", when_used="json")
    def _with_unit(self, value: Any, info: SerializationInfo) -> Any:
        del info
        if value is None or isinstance(value, float):
            return None if value is None else format_quantity(value, LOADS[self.control].dimension)
        return [
            [format_quantity(time, units.DURATION), format_quantity(load, LOADS[self.control].dimension)]
            for time, load in value
        ]

    @model_validator(mode="after")
    def _shape_has_what_it_needs(self) -> Self:
        if self.shape == "ramp_hold" and self.hold is None:
            raise problem('a load of shape "ramp_hold" needs it; give a duration such as "10 s"', key="hold")
        if self.shape in ("triangle", "ramp_hold") and (self.observations or 2) < 2:
            raise problem(f"a {self.shape} needs at least 2 observations, not {self.observations}", key="observations")
        return self


def _rows(file: Any, table: Any, control: str, info: ValidationInfo) -> Rows:
    """The rows of a load table, from its CSV file or written in place."""
    if file is None and table is None:
        raise problem(
            'a load of shape "table" needs it; give a CSV file with time_s and force_N or depth_mm',
            key="file",
        )
    if file is not None and table is not None:
        raise problem("both `file` and `table` are given; one load has one of them", key="file")
    if file is None:
        return read_rows(table, control, info)
    if not isinstance(file, str):
        raise problem(f"{file!r} is no file name", key="file")
    return read_load_file(folder_of(info) / file, control)


class LoadHistory(NamedTuple):
    """A load over time; before its first row the tissue is unloaded and at rest.

    Attributes
    ----------
    time : ndarray (n,)
        s, increasing, above zero.
    value : ndarray (n,)
        Force in N or depth in m, press positive.
    """

    time: NDArray[np.float64]
    value: NDArray[np.float64]


def load_history(load: Load) -> LoadHistory:
    """The observations of a load, k = 1..n; there is no row at time zero.

    Parameters
    ----------
    load : Load
        - triangle: row k at k/n of the duration, min(k, n - k) / (n/2) of the peak: for n = 100 that is 1..50, 49..0
          fiftieths, the history behind the paper's Table 2. An odd n steps over the peak.
        - ramp: row k at k/n of the duration, k/n of the peak.
        - ramp_hold: rows are shared between ramp and hold in proportion to their durations, at least one each, even
          in each part, so that the end of the ramp is always a row.
        - table: its own rows after time zero, or, with `observations`, n rows at k/n of its last time, interpolated
          linearly (from zero load at time zero where the table has no row there).

    Returns
    -------
    LoadHistory
        time (n,) and value (n,).
    """
    if load.table is not None:
        return _table(load.table, load.observations)
    count = load.observations or OBSERVATIONS
    step = np.arange(1, count + 1, dtype=np.float64)
    if load.shape == "ramp_hold":
        return _ramp_hold(load, count)
    share = step / count if load.shape == "ramp" else np.minimum(step, count - step) / (count / 2)
    return LoadHistory(load.duration * (step / count), load.peak * share)


def _ramp_hold(load: Load, count: int) -> LoadHistory:
    hold = load.hold or 0.0
    ramp_rows = min(max(round(count * load.duration / (load.duration + hold)), 1), count - 1)
    hold_rows = count - ramp_rows
    up = np.arange(1, ramp_rows + 1) / ramp_rows
    rest = np.arange(1, hold_rows + 1) / hold_rows
    time = np.concatenate([load.duration * up, load.duration + hold * rest])
    return LoadHistory(time, load.peak * np.concatenate([up, np.ones(hold_rows)]))


def _table(rows: tuple[tuple[float, float], ...], count: int | None) -> LoadHistory:
    time, value = np.array(rows, dtype=np.float64).T
    if count is None:
        return LoadHistory(time[time > 0], value[time > 0])
    if time[0] > 0:
        time, value = np.append(0.0, time), np.append(0.0, value)
    at = time[-1] * (np.arange(1, count + 1) / count)
    return LoadHistory(at, np.interp(at, time, value))
