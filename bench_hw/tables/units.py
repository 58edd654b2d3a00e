"""Units in column names: `gap_mm` is the quantity `gap` in millimetres.

Factors are exact fractions, so that 1 mm becomes the double nearest to 0.001 m. Free unit expressions (for
the import of foreign files) are not read here but in `mapping`.
"""

from __future__ import annotations

from fractions import Fraction

from bench_hw.tables.model import FloatArray

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
