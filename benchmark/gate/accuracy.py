"""The verdict on accuracy: each gated value against the baseline's, |now - baseline| <= rtol |baseline| + atol.

A value with a curve over the load steps is gated at each step, too: a model that is right at the peak may be wrong on
the way there. A curve is allowed rtol of its largest value, so that next to nothing at small loads is not magnified.
"""

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
from benchmark.side_by_side.runner import SAME_ANSWER

CURVE = ".curve"
"""What the name of a value's curve has behind the value's own."""
WIDE = 0.05
"""A tolerance beyond this share of a value is warned of. A choice: it is five times the change of 1 % that the shipped
gate is made to catch, and 0.5 written for 0.5 % is far beyond it."""
MOST_TOLD = 3
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
    at
        Of a curve the load step that is farthest from the baseline's, in words; None for a plain value.
    """

    quantity: str
    unit: str
    baseline: float | None
    now: float | None
    allowed: float
    passed: bool
    reason: str | None = None
    at: str | None = None

    @property
    def label(self) -> str:
        """The quantity, of a curve with the load step."""
        return self.quantity if self.at is None else f"{self.quantity} at {self.at}"

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
            "at": self.at,
        }


def compare_values(
    now: Mapping[str, StoredValue], baseline: Mapping[str, StoredValue], tolerances: Sequence[Tolerance], source: str
) -> tuple[AccuracyRow, ...]:
    """Compare each value with the baseline's, and the curves of those that are as they were.

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
    rows = [_row(name, value, baseline[name], tolerances) for name, value in now.items()]
    kept = [row.quantity for row in rows if row.passed]
    return (*rows, *(row for name in kept if (row := _curve_row(name, now[name], baseline[name], tolerances))))


def _row(name: str, now: StoredValue, base: StoredValue, tolerances: Sequence[Tolerance]) -> AccuracyRow:
    rtol, atol = tolerance_of(name, now.unit, tolerances)
    allowed = rtol * abs(base.value or 0.0) + atol
    if now.value is None or base.value is None:
        neither = now.value is None and base.value is None
        return AccuracyRow(name, now.unit, base.value, now.value, allowed, neither, now.reason)
    return AccuracyRow(name, now.unit, base.value, now.value, allowed, abs(now.value - base.value) <= allowed)


def _curve_row(name: str, now: StoredValue, base: StoredValue, tolerances: Sequence[Tolerance]) -> AccuracyRow | None:
    """The step of a curve that is farthest from the baseline's; None without two curves over the same steps."""
    farthest = farthest_step(now, base)
    if farthest is None or base.curve is None or now.curve is None:
        return None
    rtol, atol = _curve_tolerance(name, now.unit, tolerances)
    allowed = rtol * max((abs(each) for each in base.curve.values() if each is not None), default=0.0) + atol
    one, other = now.curve[farthest], base.curve[farthest]
    passed = one == other or (one is not None and other is not None and abs(one - other) <= allowed)
    reason = "it is not a finite number" if one is None else None
    return AccuracyRow(name + CURVE, now.unit, other, one, allowed, passed, reason, farthest)


def farthest_step(now: StoredValue, base: StoredValue) -> str | None:
    """The step at which two curves differ most, that of the largest value where nowhere; None without two of a kind."""
    if now.curve is None or base.curve is None or not now.curve or now.curve.keys() != base.curve.keys():
        return None
    pairs = {step: (now.curve[step], base.curve[step]) for step in now.curve}

    def apart(step: str) -> tuple[float, float]:
        one, other = pairs[step]
        if one is None or other is None:
            return (0.0, 0.0) if one == other else (math.inf, 0.0)
        return abs(one - other), abs(other)

    return max(pairs, key=apart)


def curve_remarks(now: Mapping[str, StoredValue], baseline: Mapping[str, StoredValue], source: str) -> list[str]:
    """What a reader must know of curves that cannot be compared, in one line each."""
    mine = [name for name, value in now.items() if value.curve is not None and name in baseline]
    lacking = [name for name in mine if baseline[name].curve is None]
    other = [name for name in mine if name not in lacking and farthest_step(now[name], baseline[name]) is None]
    found = []
    if lacking:
        found.append(
            f"{source} is from before values had curves: of {len(lacking)} of them only the largest is gated, not the "
            "way there over the load, until it is made anew with --accept"
        )
    if other:
        found.append(
            f"the load steps of {', '.join(other)} are others than in {source}: only the largest values are gated, not "
            "the way there, until it is made anew with --accept"
        )
    return found


def unsteady_remarks(first: Mapping[str, StoredValue], again: Mapping[str, StoredValue]) -> list[str]:
    """A warning where values of a user's model, measured once more, are others (`SAME_ANSWER`), one line."""
    apart = {name: _apart(first[name], value) for name, value in again.items()}
    farthest = max(apart, key=lambda name: apart[name], default="")
    if apart.get(farthest, 0.0) <= SAME_ANSWER:
        return []
    return [
        f"your model answers differently each time: measured once more, {farthest} is {100 * apart[farthest]:.3g} % of "
        "itself off; a model with random numbers needs a seed before it can be gated"
    ]


def _apart(one: StoredValue, other: StoredValue) -> float:
    """The largest difference between two values and their curves as a share of the largest value."""
    pairs = [(one.value or 0.0, other.value or 0.0)]
    if farthest := farthest_step(one, other):
        pairs.append(((one.curve or {})[farthest] or 0.0, (other.curve or {})[farthest] or 0.0))
    size = max(abs(each) for pair in pairs for each in pair)
    return max(abs(a - b) for a, b in pairs) / size if size else 0.0


def wide_remarks(values: Mapping[str, StoredValue], tolerances: Sequence[Tolerance]) -> list[str]:
    """A warning of tolerances so wide that they gate little (`WIDE`), one line; raises as `tolerance_of`.

    An atol counts where a value is the largest of a load history; others, such as a force zero, may be next to nothing.
    """
    wide: dict[str, float] = {}
    for name, value in values.items():
        rtol, atol = tolerance_of(name, value.unit, tolerances)
        size = abs(value.value or 0.0) if value.curve is not None else 0.0
        wide[name] = rtol + (atol / size if size else 0.0)
        own = rtol if value.curve is None else _curve_tolerance(name, value.unit, tolerances)[0]
        if own != rtol:
            wide[name + CURVE] = own
    wide = {name: share for name, share in wide.items() if share > WIDE}
    if not wide:
        return []
    told = [f"{name} ({100 * share:.3g} %)" for name, share in list(wide.items())[:MOST_TOLD]]
    more = f" and {len(wide) - MOST_TOLD} more" if len(wide) > MOST_TOLD else ""
    return [
        f"tolerances so wide that they gate little: {', '.join(told)}{more}; beyond {100 * WIDE:g} % a model can be "
        'plainly wrong and pass (0.5 is 50 %, half a per cent is "0.5 %")'
    ]


def _curve_tolerance(name: str, unit: str, tolerances: Sequence[Tolerance]) -> tuple[float, float]:
    """What a tolerance for curves alone says (its pattern ends with .curve), else what holds for the value itself."""
    own = [each for each in tolerances if each.quantity.endswith(CURVE)]
    fits = any(fnmatch.fnmatchcase(name + CURVE, each.quantity) for each in own)
    return tolerance_of(name + CURVE, unit, own) if fits else tolerance_of(name, unit, tolerances)


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
