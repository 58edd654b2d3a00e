"""Errors of the finite-element package, and checks of single input values that raise them.

A run that does not converge is not an error here; it is a :class:`fem.results.solution.Solution` with a
:class:`fem.results.solution.Failure`. Each message says what is allowed.
"""

from __future__ import annotations

import math
from collections.abc import Collection


class FemError(ValueError):
    """Input the solver cannot use; the message names the parameter, its value, its unit and what is allowed."""


class CheckpointError(FemError):
    """A checkpoint that cannot be written, is damaged, or belongs to another problem.

    Attributes
    ----------
    problem
        What is wrong; the message goes on with what to do.
    """

    def __init__(self, problem: str, remedy: str = ""):
        super().__init__(f"{problem}; {remedy}" if remedy else problem)
        self.problem = problem


class NotDifferentiableError(FemError):
    """A change of a problem by which its steps cannot be differentiated directly; differences of runs may do."""


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
