"""Units in column names: `gap_mm` is the quantity `gap` in millimetres; and `--map`, which names a column's own unit.

Factors are exact fractions, so that 1 mm becomes the double nearest to 0.001 m. Any other unit, for the import of
foreign files, is read by pint.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from bench_hw.configuration import parse_quantity
from bench_hw.errors import InputError

FloatArray = NDArray[np.float64]

_MILLI = Fraction(1, 1000)
_MICRO = Fraction(1, 1_000_000)

_ONE, _KILO, _MEGA = Fraction(1), Fraction(1000), Fraction(1_000_000)

UNITS: dict[str, tuple[Fraction, str]] = {
    "s": (_ONE, "s"),
    "ms": (_MILLI, "s"),
    "us": (_MICRO, "s"),
    "m": (_ONE, "m"),
    "cm": (Fraction(1, 100), "m"),
    "mm": (_MILLI, "m"),
    "um": (_MICRO, "m"),
    "N": (_ONE, "N"),
    "mN": (_MILLI, "N"),
    "kN": (_KILO, "N"),
    "Nm": (_ONE, "N*m"),
    "Nmm": (_MILLI, "N*m"),
    "mNm": (_MILLI, "N*m"),
    "Pa": (_ONE, "Pa"),
    "kPa": (_KILO, "Pa"),
    "MPa": (_MEGA, "Pa"),
    "V": (_ONE, "V"),
    "mV": (_MILLI, "V"),
    "Hz": (_ONE, "Hz"),
    "kHz": (_KILO, "Hz"),
    "m_per_s": (_ONE, "m/s"),
    "mm_per_s": (_MILLI, "m/s"),
}
"""Value of one unit in SI, and that SI unit, by the ending a column name may have."""


def split_unit(column: str) -> tuple[str, str]:
    """Split a column name into quantity and unit, `("gap", "mm")`; unit "" where there is none it knows."""
    endings = [unit for unit in UNITS if column.endswith(f"_{unit}") and len(column) > len(unit) + 1]
    unit = max(endings, key=len, default="")
    return (column[: -len(unit) - 1], unit) if unit else (column, "")


def join_unit(quantity: str, unit: str) -> str:
    """Give the column name of a quantity in a unit; the name alone without one."""
    return f"{quantity}_{unit}" if unit else quantity


def to_si(values: FloatArray, unit: str) -> FloatArray:
    """Turn numbers in a unit of `UNITS` (or "", none) into SI; correctly rounded."""
    factor = UNITS[unit][0] if unit else _ONE
    return values * float(factor.numerator) / float(factor.denominator)


def from_si(values: FloatArray, unit: str) -> FloatArray:
    """Turn SI values into numbers in a unit of `UNITS` (or "", none)."""
    factor = UNITS[unit][0] if unit else _ONE
    return values * float(factor.denominator) / float(factor.numerator)


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
