"""Text with a unit to an SI number and back, exactly; pint knows the units, this module knows the house rules.

A quantity is one decimal number and one unit, "120 kPa". The number is multiplied by the unit's factor in decimal
arithmetic and rounded once, so "11.6 mm" is the float 0.0116 and what `format_quantity` writes reads back as the
same float.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Context, Decimal, localcontext
from functools import cache
from typing import Any

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?")
_UNIT = re.compile(r"(?:[A-Za-zµμ°%][A-Za-zµμ°²³·*/^()\d. +-]{0,40})?")
_PRECISION = 60
_MOST_DIGITS = 40


@dataclass(frozen=True)
class Dimension:
    """A physical dimension as files know it.

    Attributes
    ----------
    name : str
        "length", as it stands in messages.
    si : str
        The SI unit, in pint's spelling; "" for a plain number.
    units : tuple of (str, float)
        Units in which values are written, each with the smallest SI magnitude written in it, the largest first.
    example : str
        A value one could give.
    """

    name: str
    si: str
    units: tuple[tuple[str, float], ...]
    example: str

    @property
    def article(self) -> str:
        """The name with its indefinite article, "an angle"."""
        return f"{'an' if self.name[0] in 'aeiou' else 'a'} {self.name}"

    @property
    def usual_unit(self) -> str:
        """The unit of the example."""
        return self.example.split(" ", 1)[1]


LENGTH = Dimension("length", "m", (("m", 1.0), ("mm", 1e-5), ("um", 0.0)), "1.5 mm")
PRESSURE = Dimension("pressure", "Pa", (("MPa", 1e6), ("kPa", 1e2), ("Pa", 0.0)), "120 kPa")
FORCE = Dimension("force", "N", (("kN", 1e4), ("N", 1e-3), ("mN", 0.0)), "5 N")
DURATION = Dimension("duration", "s", (("s", 0.01), ("ms", 0.0)), "10 s")
SPEED = Dimension("speed", "m/s", (("m/s", 1.0), ("mm/s", 0.0)), "2 mm/s")
DENSITY = Dimension("density", "kg/m^3", (("kg/m^3", 0.0),), "1100 kg/m^3")
ANGLE = Dimension("angle", "radian", (("deg", 0.0),), "30 deg")
FREQUENCY = Dimension("frequency", "1/s", (("Hz", 0.0),), "30 Hz")
STIFFNESS = Dimension("stiffness", "N/m", (("N/mm", 1.0), ("N/m", 0.0)), "20 N/mm")
DIFFUSIVITY = Dimension("diffusivity", "m^2/s", (("mm^2/s", 0.0),), "0.5 mm^2/s")
FRACTION = Dimension("fraction", "", (("%", 0.0),), "2 %")

DIMENSIONS = (LENGTH, PRESSURE, FORCE, DURATION, SPEED, DENSITY, ANGLE, FREQUENCY, STIFFNESS, DIFFUSIVITY, FRACTION)


_NUMBER_ALONE = Dimension("plain number", "", (("", 0.0),), "0.3 ")
_BY_UNIT = {
    **{each.si: each for each in DIMENSIONS if each.si},
    "m/N": Dimension("compliance", "m/N", (("mm/N", 0.0),), "0.1 mm/N"),
    "N/m": Dimension("stiffness", "N/m", (("N/mm", 100.0), ("N/m", 0.0)), "1.5 N/mm"),
    "kg": Dimension("mass", "kg", (("kg", 1.0), ("g", 0.0)), "20 g"),
    "": _NUMBER_ALONE,
}
_SHOWN = {
    "m": (1e3, "mm"),
    "Pa": (1e-3, "kPa"),
    "m/s": (1e3, "mm/s"),
    "m/N": (1e3, "mm/N"),
    "N/m": (1e-3, "N/mm"),
    "m^2/s": (1e6, "mm^2/s"),
    "kg": (1e3, "g"),
}
"""Factor and name of the unit that readers get for an SI unit."""


def dimension_of(unit: str) -> Dimension:
    """The dimension whose SI unit is `unit` ("" for a plain number), with the units that people read it in."""
    spelled = _pint_spelling(unit)
    return _BY_UNIT.get(spelled, Dimension(f"quantity in {unit}", spelled, ((spelled, 0.0),), f"1 {spelled}"))


def shown(value: float, unit: str) -> tuple[float, str]:
    """A value in an SI unit as number and unit for a reader: lengths in mm, pressures in kPa, compliance in mm/N."""
    factor, name = _SHOWN.get(_pint_spelling(unit), (1.0, unit))
    return factor * value, name


def _pint_spelling(unit: str) -> str:
    plain = unit.replace("m2/s", "m^2/s").replace("m**2/s", "m^2/s")
    return {"rad": "radian", "Hz": "1/s", "1/m": "m^-1"}.get(plain, plain)


class QuantityError(ValueError):
    """A text that is no quantity of the wanted dimension; the message says what was given and what is wanted."""


def parse_quantity(text: str, dimension: Dimension) -> float:
    """Read a quantity.

    Parameters
    ----------
    text : str
        One decimal number and one unit, such as "120 kPa"; a fraction may come without a unit.
    dimension : Dimension
        What it has to be.

    Returns
    -------
    float
        The value in the dimension's SI unit (radian for an angle, 0.02 for "2 %"), finite.

    Raises
    ------
    QuantityError
        When the text is no number with a unit, is not finite, or is of another dimension.
    """
    if split_uncertainty(text)[1] is not None:
        raise QuantityError(
            f"{text!r} has an uncertainty, which is not read here; give {dimension.article} alone, such as "
            f"{dimension.example!r}"
        )
    number, unit = _split(text, dimension)
    if not unit and dimension.si:
        raise QuantityError(
            f"{text!r} has no unit; give {dimension.article} with its unit, such as {dimension.example!r}"
        )
    factor, base = _unit_factor(unit)
    if base is None:
        near = [each for each, _ in dimension.units if each.casefold() == unit.casefold()]
        meant = f"; give {dimension.article} such as {dimension.example!r}"
        meant = f" for {dimension.article}; did you mean {near[0]}?" if near else meant
        raise QuantityError(f"{text!r}: the unit {unit!r} is not known{meant}")
    if base != _base_of(dimension):
        given = _dimension_name(base)
        raise QuantityError(f"{text!r} is {given}, not {dimension.article}; give one such as {dimension.example!r}")
    with localcontext(Context(prec=_PRECISION)):
        value = float(Decimal(number) * factor)
    if math.isinf(value):
        raise QuantityError(f"{text!r} is too large to be {dimension.article}")
    return value


_PLUS_MINUS = re.compile(r"\s*(?:\+/-|±)\s*")


def split_uncertainty(text: str) -> tuple[str, str | None]:
    """A quantity's text and that of its standard uncertainty, "5 mm" and "0.05 mm" of "5 mm +/- 0.05 mm"; or None."""
    parts = _PLUS_MINUS.split(text, maxsplit=1)
    return (parts[0], parts[1]) if len(parts) == 2 else (text, None)


def relative_uncertainty(value: float, text: str, dimension: Dimension) -> float:
    """Read a standard uncertainty as a share of its value.

    Parameters
    ----------
    value : float
        The value that it belongs to, in the dimension's SI unit.
    text : str
        A quantity of the same dimension, "0.05 mm", or a share of the value, "1 %".
    dimension : Dimension
        The value's.

    Raises
    ------
    QuantityError
        When it is no such quantity, or not above 0 and below 100 % of the value.
    """
    try:
        share = text.rstrip().endswith("%")
        size = parse_quantity(text, FRACTION) if share else parse_quantity(text, dimension)
    except QuantityError as error:
        raise QuantityError(f"the uncertainty {error}, or a share of the value such as '5 %'") from None
    if not share and value:
        size /= abs(value)
    if not 0.0 < size < 1.0 or not value:
        raise QuantityError(
            f"the uncertainty {text!r} is outside what is allowed, above 0 % and below 100 % of the value"
        )
    return size


def format_quantity(value: float, dimension: Dimension) -> str:
    """Write an SI value with a unit a person would choose, such that it reads back as the same float.

    Parameters
    ----------
    value : float
        In the dimension's SI unit, finite.
    dimension : Dimension
        What it is.

    Returns
    -------
    str
        "120 kPa" for 120000.0 and `PRESSURE`.
    """
    if not math.isfinite(value):
        raise QuantityError(f"{value!r} is not finite and cannot be written as {dimension.article}")
    for unit in (_readable_unit(value, dimension), dimension.si):
        factor, _ = _unit_factor(unit)
        text = f"{_shortest(value, factor)} {unit}".strip()
        if parse_quantity(text, dimension) == value:
            return text
    raise AssertionError(f"{value!r} {dimension.si} does not read back")


def shown_quantity(value: float, dimension: Dimension) -> str:
    """Write an SI value for a message: six digits and a readable unit."""
    unit = _readable_unit(value, dimension)
    return f"{value / float(_unit_factor(unit)[0]):.6g} {unit}"


def _split(text: str, dimension: Dimension) -> tuple[str, str]:
    """The number and the unit of a quantity's text."""
    stripped = text.strip()
    match = _NUMBER.match(stripped)
    unit = stripped[match.end() :].strip() if match else ""
    if match is None or len(match.group()) > _MOST_DIGITS or not _UNIT.fullmatch(unit):
        shown = text if len(text) <= 60 else text[:57] + "..."
        raise QuantityError(
            f"{shown!r} is not a finite number with a unit; give {dimension.article} such as {dimension.example!r}"
        )
    return match.group(), unit


def _readable_unit(value: float, dimension: Dimension) -> str:
    """The first of the dimension's units that the value is large enough for; the usual one for zero."""
    if not value:
        return dimension.usual_unit
    return next(unit for unit, smallest in dimension.units if abs(value) >= smallest * (1 - 1e-12))


def _shortest(value: float, factor: Decimal) -> str:
    """`value / factor` in the fewest digits that are exact when the factor is a power of ten."""
    with localcontext(Context(prec=25)):
        scaled = (Decimal(repr(float(value))) / factor).normalize()
    rounded = repr(float(scaled))
    with localcontext(Context(prec=_PRECISION)):
        short = rounded if float(Decimal(rounded) * factor) == value else str(scaled)
    return short.removesuffix(".0")


def _base_of(dimension: Dimension) -> str:
    """The dimension's SI unit in the registry's own spelling."""
    base = _unit_factor(dimension.si)[1]
    assert base is not None, f"{dimension.si} is an SI unit"
    return base


def _dimension_name(base: str) -> str:
    """What a base unit measures, "a pressure"; the unit itself where the house has no word."""
    known = {_base_of(each): each.article for each in DIMENSIONS if each.si}
    return known.get(base, "a plain number" if base == "dimensionless" else f"a quantity in {base}")


@cache
def _unit_factor(unit: str) -> tuple[Decimal, str | None]:
    """A unit's factor to SI base units and these units; (1, None) for a unit that pint does not know."""
    registry = _registry()
    spelled = re.sub(r"(?<=[A-Za-z])(-?\d)", r"^\1", unit)
    try:
        in_base = registry.Quantity(Decimal(1), registry.parse_units(spelled)).to_base_units()
    except Exception:  # pint's parser raises a dozen kinds, down to tokenize and arithmetic errors
        return Decimal(1), None
    return Decimal(in_base.magnitude), str(in_base.units)


@cache
def _registry() -> Any:
    """The registry of pint in decimal arithmetic, built at first use: it takes a quarter of a second."""
    import pint

    return pint.UnitRegistry(non_int_type=Decimal)
