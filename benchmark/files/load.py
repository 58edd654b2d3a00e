"""The load of a scenario: how high, how long, in what shape; `load_history` makes the rows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import field_serializer, field_validator, model_validator
from pydantic_core.core_schema import SerializationInfo, ValidationInfo

from benchmark.files import units
from benchmark.files.base import FileModel
from benchmark.files.load_table import LOADS, Rows, read_load_file, read_rows
from benchmark.files.quantities import Bounds, Duration, Number, problem
from benchmark.files.sources import folder_of
from benchmark.files.units import format_quantity

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
        if not peak:
            raise problem(f"{value!r} is no press; allowed: any {kind.dimension.name} but zero, within {kind.allowed}")
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
