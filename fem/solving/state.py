"""A state of equilibrium on the way, and how a Newton run ended."""

from __future__ import annotations

from dataclasses import dataclass

from fem.arrays import FloatArray


@dataclass(frozen=True)
class State:
    """Displacement, pressure and force, in equilibrium or a guess at it.

    Attributes
    ----------
    y
        Unknowns (n,) in m.
    pressure
        Pressure coefficients (3, E).
    force
        Press of the tool in N.
    """

    y: FloatArray
    pressure: FloatArray
    force: float


@dataclass(frozen=True)
class NewtonResult:
    """How a Newton run ended.

    Attributes
    ----------
    state
        The state reached; in equilibrium if `reason` is empty.
    iterations
        Number of Newton corrections made.
    reason
        Why it failed, or "".
    """

    state: State
    iterations: int
    reason: str = ""

    @property
    def success(self) -> bool:
        """Whether equilibrium was found."""
        return not self.reason
