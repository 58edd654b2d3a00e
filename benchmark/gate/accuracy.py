"""The verdict on accuracy: each gated value against the baseline's, |now - baseline| <= rtol |baseline| + atol."""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from benchmark.errors import InputError, NotComparableError
from benchmark.files.units import FORCE, FRACTION, LENGTH, Dimension, QuantityError, parse_quantity
from benchmark.gate.baseline import StoredValue
from benchmark.gate.gate_file import Tolerance

UNITS: Mapping[str, tuple[Dimension, float]] = {"mm": (LENGTH, 1e-3), "N": (FORCE, 1.0), "": (FRACTION, 1.0)}
"""Units of gated values, each with its dimension and its size in SI units."""


@dataclass(frozen=True)
class AccuracyRow:
    """One gated value.

    Attributes
    ----------
    quantity, unit
        Its name and unit.
    baseline, now
        Its values; None where a solver has none.
    allowed
        The largest difference between them that passes, in the same unit.
    passed
        Whether they are that close.
    reason
        Why there is no value now; None where there is one.
    """

    quantity: str
    unit: str
    baseline: float | None
    now: float | None
    allowed: float
    passed: bool
    reason: str | None = None

    @property
    def share(self) -> float:
        """The difference as a share of what is allowed; infinite where there is no value."""
        if self.now is None or self.baseline is None:
            return 0.0 if self.passed else math.inf
        return abs(self.now - self.baseline) / self.allowed if self.now != self.baseline else 0.0

    def to_dict(self) -> dict[str, Any]:
        """The row for `check.json`."""
        return {
            "quantity": self.quantity,
            "unit": self.unit,
            "baseline": self.baseline,
            "now": self.now,
            "allowed": self.allowed,
            "passed": self.passed,
            "reason": self.reason,
        }


def compare_values(
    now: Mapping[str, StoredValue], baseline: Mapping[str, StoredValue], tolerances: Sequence[Tolerance], source: str
) -> tuple[AccuracyRow, ...]:
    """Compare each value with the baseline's.

    Parameters
    ----------
    now, baseline
        By quantity.
    tolerances
        The first whose pattern fits a name holds.
    source
        What the baseline is, for messages.

    Raises
    ------
    NotComparableError
        A quantity is missing on one side, or has another unit there.
    InputError
        No tolerance fits a quantity, or its atol has another dimension.
    """
    apart = [name for name in {**now, **baseline} if name not in now or name not in baseline]
    apart += [
        f"{name} (in {baseline[name].unit or '1'} there, in {value.unit or '1'} here)"
        for name, value in now.items()
        if name in baseline and value.unit != baseline[name].unit
    ]
    if apart:
        raise NotComparableError(
            f"{source} and this version do not have the same gated quantities: {', '.join(apart)}; "
            "after a wanted change make a new baseline with --accept"
        )
    return tuple(_row(name, value, baseline[name], tolerances) for name, value in now.items())


def _row(name: str, now: StoredValue, base: StoredValue, tolerances: Sequence[Tolerance]) -> AccuracyRow:
    rtol, atol = tolerance_of(name, now.unit, tolerances)
    allowed = rtol * abs(base.value or 0.0) + atol
    if now.value is None or base.value is None:
        neither = now.value is None and base.value is None
        return AccuracyRow(name, now.unit, base.value, now.value, allowed, neither, now.reason)
    return AccuracyRow(name, now.unit, base.value, now.value, allowed, abs(now.value - base.value) <= allowed)


def tolerance_of(name: str, unit: str, tolerances: Sequence[Tolerance]) -> tuple[float, float]:
    """Return rtol (a fraction) and atol (in `unit`) of a quantity; raises as `compare_values`."""
    found = next((each for each in tolerances if fnmatch.fnmatchcase(name, each.quantity)), None)
    if found is None:
        raise InputError(
            f'no tolerance of the gate file fits the quantity {name}; add a last one for all, quantity = "*"'
        )
    dimension, size = UNITS[unit]
    try:
        return found.rtol, parse_quantity(found.atol, dimension) / size
    except QuantityError as error:
        raise InputError(
            f"tolerance {found.quantity!r} of the gate file, atol, for the quantity {name}: {error}"
        ) from None
