"""The fading part of a layer's stiffness: a Prony series on the isochoric stress."""

from __future__ import annotations

from dataclasses import dataclass

from fem.checks import require_positive
from fem.errors import FemError


@dataclass(frozen=True)
class PronyTerm:
    """One fading part.

    Attributes
    ----------
    g
        Fraction of the initial shear stiffness that fades, above 0 and below 1.
    tau
        Time constant in s, above 0.

    Raises
    ------
    FemError
        If a value is outside its range.
    """

    g: float
    tau: float

    def __post_init__(self) -> None:
        if not 0.0 < self.g < 1.0:
            raise FemError(f"relaxation: g = {self.g:g}: must be above 0 and below 1")
        require_positive("relaxation: tau", self.tau, "s")


def require_something_left(terms: tuple[PronyTerm, ...], where: str) -> None:
    """Refuse a series that leaves no stiffness.

    Raises
    ------
    FemError
        If the fractions add up to 1 or more.
    """
    total = sum(term.g for term in terms)
    if total >= 1.0:
        raise FemError(f"{where}: the fractions g add up to {total:.6g}, their sum must stay below 1")
