"""Checks of single input values, each with one message that says what is allowed."""

from __future__ import annotations

import math
from collections.abc import Collection

from fem.errors import FemError


def require_positive(name: str, value: float, unit: str) -> None:
    """Refuse a value that is not a finite number above zero.

    Raises
    ------
    FemError
        If `value` (in `unit`) is not finite or not positive.
    """
    if not math.isfinite(value) or value <= 0.0:
        raise FemError(f"{name} = {value:g} {unit}: must be a finite number above 0 {unit}")


def require_one_of(name: str, value: str, allowed: Collection[str]) -> None:
    """Refuse a word that is not in `allowed`.

    Raises
    ------
    FemError
        If `value` is unknown; the message lists the allowed words.
    """
    if value not in allowed:
        raise FemError(f"{name} = {value!r}: allowed are {', '.join(sorted(allowed))}")


def require_finite(name: str, value: float, unit: str) -> None:
    """Refuse a value that is infinite or not a number.

    Raises
    ------
    FemError
        If `value` (in `unit`) is not finite.
    """
    if not math.isfinite(value):
        raise FemError(f"{name} = {value:g} {unit}: must be a finite number")
