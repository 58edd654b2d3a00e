"""What a verification case is: a source, a computation, and the compared quantities it gives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """One number of ours against a reference.

    Attributes
    ----------
    name
        Short name within its case, without blanks or "/"; "" where the case has only one.
    reference
        Published or closed-form value, not zero.
    ours
        Our value.
    unit
        Unit of both; "" for a pure number.
    allowed_percent
        Largest error, in percent of the reference, with which the case passes.
    unknowns
        Displacement unknowns of the discrete problem.
    """

    name: str
    reference: float
    ours: float
    unit: str
    allowed_percent: float
    unknowns: int

    @property
    def error_percent(self) -> float:
        """100 (ours - reference) / |reference|."""
        return 100.0 * (self.ours - self.reference) / abs(self.reference)

    @property
    def share_of_allowed(self) -> float:
        """Size of the error over what is allowed; infinite where the error is not a number."""
        share = abs(self.error_percent) / self.allowed_percent
        return share if math.isfinite(share) else math.inf

    @property
    def passed(self) -> bool:
        """Whether the error is a number and within what is allowed."""
        return self.share_of_allowed <= 1.0


@dataclass(frozen=True)
class Case:
    """A computation whose answer is known.

    Attributes
    ----------
    name
        Words parted by "/", the family first.
    source
        Where the reference comes from.
    compute
        Runs the case; at least one quantity.
    """

    name: str
    source: str
    compute: Callable[[], tuple[Quantity, ...]]
