"""A load given as rows of time and value, in a CSV file or in the scenario itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from pydantic_core import PydanticCustomError
from pydantic_core.core_schema import ValidationInfo

from bench_hw.tables import TableError
from bench_hw.tables.columns import check_increasing, read_columns
from bench_hw.tables.source import read_source
from bench_hw.tables.units import to_si
from benchmark.errors import InputError
from benchmark.files import units
from benchmark.files.quantities import Quantity, problem, quantity

Rows = tuple[tuple[float, float], ...]

LOADS: Final[dict[str, Quantity]] = {
    "force": quantity(units.FORCE, -1e9, 1e9),
    "depth": quantity(units.LENGTH, -1e3, 1e3),
}
"""What the values of a load measure under each control."""

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
