"""Which column of a foreign file is which column of a trial, and in which unit."""

from __future__ import annotations

from dataclasses import dataclass

from bench_hw.errors import InputError
from bench_hw.quantities import parse_quantity
from bench_hw.tables.units import UNITS, split_unit


@dataclass(frozen=True)
class ColumnMap:
    """One column of the result.

    Parameters
    ----------
    target : str
        Its name, with the unit it gets: `depth_mm`.
    source : str
        The column of the foreign file: its header, or `#3` for the third.
    factor : float
        By which its numbers are multiplied to be in the target's unit.
    """

    target: str
    source: str
    factor: float


def parse_map(text: str) -> ColumnMap:
    """Read `TARGET=SOURCE:UNIT`, for instance `depth_mm=Position [um]:um`.

    The unit is any that pint knows (`gf`, `lbf`, `inch`, `ms`), the part after the last colon; without a colon
    the numbers are in the target's own unit. A source with a colon in its name needs one more at the end.

    Raises
    ------
    InputError
        No `=`, no source, or a unit that is none or of another dimension.
    """
    target, equals, rest = text.partition("=")
    source, _, unit = rest.rpartition(":") if ":" in rest else (rest, "", "")
    target, source, unit = target.strip(), source.strip(), unit.strip()
    if not equals or not target or not source:
        raise InputError(f'--map {text!r}; allowed: TARGET=SOURCE or TARGET=SOURCE:UNIT, "depth_mm=Pos:um"')
    return ColumnMap(target, source, _factor(text, target, unit) if unit else 1.0)


def _factor(text: str, target: str, unit: str) -> float:
    own = split_unit(target)[1]
    if not own:
        raise InputError(f"--map {text!r}: {target!r} has no unit to convert to; allowed: a name like gap_mm")
    factor, si = UNITS[own]
    try:
        return parse_quantity(f"1 {unit}", si) * float(factor.denominator) / float(factor.numerator)
    except ValueError as error:
        raise InputError(f"--map {text!r}: {unit!r} is no unit that converts to {own}") from error


def parse_rate(text: str) -> float:
    """Read a rate such as `100 Hz`, in Hz.

    Raises
    ------
    InputError
        It is none.
    """
    try:
        return parse_quantity(text, "Hz")
    except ValueError as error:
        raise InputError(f"--rate: {error}") from error
