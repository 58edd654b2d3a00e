"""The field types of every input file: quantities with units, plain numbers, counts and names, each with its bounds.

In a file a quantity is text with a unit. In code it is a float in SI units, so a model built in Python takes
`thickness=1.5e-3`. Which of the two rules applies is told by the validation context (`FROM_FILE`).
"""

from __future__ import annotations

import math
import typing
from dataclasses import dataclass
from typing import Annotated, Any, Final

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema
from pydantic_core.core_schema import SerializationInfo, ValidationInfo

from benchmark.files import units
from benchmark.files.units import (
    Dimension,
    QuantityError,
    dimension_of,
    format_quantity,
    parse_quantity,
    relative_uncertainty,
    shown_quantity,
    split_uncertainty,
)

FROM_FILE: Final = {"from_file": True}
"""The validation context of values that were written by a person: quantities must carry their unit."""


LONGEST: Final = 60
"""Characters of a value in a message."""


def problem(text: str, **context: Any) -> PydanticCustomError:
    """A validation error whose text goes to the person as it is.

    Parameters
    ----------
    text : str
        What is wrong and what is allowed, without the place.
    **context
        `key`: the dotted key it belongs to, where a rule over several keys failed; list entries by their index.
    """
    return PydanticCustomError("tissuebench", "{text}", {"text": text, **context})


def shortened(value: Any) -> str:
    """A value as a message shows it: at most 60 characters."""
    text = repr(value)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


@dataclass(frozen=True)
class Bounds:
    """An interval of allowed values in SI units; the low end may be excluded."""

    low: float
    high: float
    above: bool = False

    def admit(self, value: float) -> bool:
        """Whether a value lies inside; NaN never does."""
        return (self.low < value if self.above else self.low <= value) and value <= self.high


@dataclass(frozen=True)
class Quantity:
    """Field annotation: a float in SI units, written in files as text with a unit.

    Attributes
    ----------
    dimension : Dimension
        What the unit must measure.
    bounds : Bounds
        What is allowed.
    automatic : bool
        Whether "auto" may stand instead, which is None in code.
    endless : bool
        Whether the value may be infinite in code, where the file leaves the key out.
    """

    dimension: Dimension
    bounds: Bounds
    automatic: bool = False
    endless: bool = False

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """How pydantic checks and writes a field of this kind."""
        del source, handler
        return core_schema.with_info_plain_validator_function(
            self.validate,
            serialization=core_schema.plain_serializer_function_ser_schema(self.serialize, info_arg=True),
        )

    def validate(self, value: Any, info: ValidationInfo) -> float | None:
        """The SI value of what a file or a caller gave; a `PydanticCustomError` says why it cannot be one."""
        if self.automatic and value in (None, "auto"):
            return None
        number = self._read(value, from_file=bool(info.context))
        if not (self.bounds.admit(number) or (self.endless and number == math.inf)):
            raise problem(f"{self._shown(value, number)} is outside what is allowed, {self.allowed}")
        return number

    def serialize(self, value: float | None, info: SerializationInfo) -> float | str | None:
        """The text with unit for files, the plain value otherwise."""
        if info.mode != "json":
            return value
        if value is None:
            return "auto" if self.automatic else None
        return None if math.isinf(value) else format_quantity(value, self.dimension)

    @property
    def allowed(self) -> str:
        """The bounds in words, with units."""
        low, high = (shown_quantity(end, self.dimension) for end in (self.bounds.low, self.bounds.high))
        span = f"above {low} and at most {high}" if self.bounds.above else f"{low} to {high}"
        return f'{span}, or "auto"' if self.automatic else span

    def _read(self, value: Any, *, from_file: bool) -> float:
        if isinstance(value, str):
            try:
                return parse_quantity(value, self.dimension)
            except QuantityError as error:
                raise problem(f"{error} (allowed: {self.allowed})") from None
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise problem(f"{shortened(value)} is not {self.dimension.article}; allowed: {self.allowed}")
        if from_file and self.dimension.si:
            number = value if 0 < value < math.inf else self.dimension.example.split(" ")[0]
            hint = f'"{number} {self.dimension.usual_unit}"'
            raise problem(
                f"the bare number {shortened(value)} has no unit; write {self.dimension.article} as text with its "
                f"unit, such as {hint} (allowed: {self.allowed})"
            )
        return float(value)

    def _shown(self, value: Any, number: float) -> str:
        if isinstance(value, str) or not math.isfinite(number):
            return shortened(value)
        return shown_quantity(number, self.dimension)


@dataclass(frozen=True)
class Number:
    """Field annotation: a plain finite number (no unit), or a whole one; text from the command line is read too.

    Attributes
    ----------
    allowed : str
        The bounds in words.
    bounds : Bounds
        What is allowed.
    whole : bool
        Whether it must be an integer.
    automatic : bool
        Whether "auto" may stand instead, which is None in code.
    """

    allowed: str
    bounds: Bounds
    whole: bool = False
    automatic: bool = False

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """How pydantic checks and writes a field of this kind."""
        del source, handler
        return core_schema.no_info_plain_validator_function(
            self.validate,
            serialization=core_schema.plain_serializer_function_ser_schema(self.serialize, info_arg=True),
        )

    def validate(self, value: Any) -> float | int | None:
        """The number given; a `PydanticCustomError` says why it cannot be one."""
        if self.automatic and value in (None, "auto"):
            return None
        kind = "a whole number" if self.whole else "a number"
        try:
            number = float(value) if not isinstance(value, bool) else math.nan
        except (TypeError, ValueError, OverflowError):
            number = math.nan
        if math.isnan(number) or (self.whole and not number.is_integer()):
            raise problem(f"{shortened(value)} is not {kind}; allowed: {self.allowed}")
        if not self.bounds.admit(number):
            raise problem(f"{shortened(value)} is outside what is allowed, {self.allowed}")
        return int(number) if self.whole else number

    def serialize(self, value: float | None, info: SerializationInfo) -> float | str | None:
        """The number; "auto" in files where it is automatic."""
        return "auto" if self.automatic and value is None and info.mode == "json" else value


def quantity_of(annotation: Any) -> Dimension | None:
    """The dimension of a field whose value may carry an uncertainty; None of names, counts and fractions."""
    for part in (annotation, *typing.get_args(annotation)):
        if isinstance(part, Quantity) and part.dimension.si:
            return part.dimension
        if isinstance(part, Number) and not part.whole:
            return dimension_of("")
    inner = (found for part in typing.get_args(annotation) if typing.get_args(part) for found in (quantity_of(part),))
    return next((found for found in inner if found is not None), None)


def without_uncertainty(text: str, dimension: Dimension) -> tuple[str, float | None]:
    """The text of the value alone, and the relative standard uncertainty where it carries one ("5 mm +/- 1 %").

    Raises
    ------
    PydanticCustomError
        The uncertainty cannot be one of this value.
    """
    plain, uncertain = split_uncertainty(text)
    if uncertain is None:
        return text, None
    unit = uncertain.lstrip("+-.0123456789eE ")
    if dimension.si and unit not in ("", "%") and plain and plain[-1].isdigit():
        raise problem(f"{text!r}: the value {plain!r} has no unit; write it to both, '{plain} {unit} +/- {uncertain}'")
    try:
        return plain, relative_uncertainty(parse_quantity(plain, dimension), uncertain, dimension)
    except QuantityError as error:
        raise problem(str(error)) from None


def quantity(dimension: Dimension, low: float, high: float, **options: bool) -> Quantity:
    """A `Quantity` between two SI values; `options` are `above` of the bounds, and `automatic`, `endless`."""
    return Quantity(dimension, Bounds(low, high, options.pop("above", False)), **options)


Length = Annotated[float, quantity(units.LENGTH, 1e-9, 1e5)]
SignedLength = Annotated[float, quantity(units.LENGTH, -1e5, 1e5)]
AutoLength = Annotated[float | None, quantity(units.LENGTH, 1e-9, 1e7, automatic=True)]
Thickness = Annotated[float, quantity(units.LENGTH, 1e-7, 1e5, endless=True)]
Modulus = Annotated[float, quantity(units.PRESSURE, 0.01, 1e12)]
SignedModulus = Annotated[float, quantity(units.PRESSURE, -1e12, 1e12)]
Pressure = Annotated[float, quantity(units.PRESSURE, 0.0, 1e12)]
Force = Annotated[float, quantity(units.FORCE, 1e-6, 1e9)]
Duration = Annotated[float, quantity(units.DURATION, 1e-6, 1e7)]
Stiffness = Annotated[float, quantity(units.STIFFNESS, 0.0, 1e8, above=True)]
Diffusivity = Annotated[float, quantity(units.DIFFUSIVITY, 1e-15, 1.0)]
Travel = Annotated[float, quantity(units.LENGTH, 1e-9, 1.0)]
PullOff = Annotated[float, quantity(units.FORCE, 0.0, 1e3)]
SlipForce = Annotated[float, quantity(units.FORCE, 0.0, 1e3, above=True)]
Density = Annotated[float, quantity(units.DENSITY, 0.01, 1e5)]
Angle = Annotated[float, quantity(units.ANGLE, -math.pi, math.pi)]
Tilt = Annotated[float, quantity(units.ANGLE, -math.radians(60), math.radians(60))]
Margin = Annotated[float, quantity(units.FRACTION, 0.0, 1.0, above=True)]
