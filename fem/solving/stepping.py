"""From one prescribed load to the next, in as many parts as Newton needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from fem.arrays import FloatArray
from fem.solving.equilibrium import Equilibrium
from fem.solving.newton import NewtonSettings, solve_newton
from fem.solving.predictor import KnownStates
from fem.solving.state import State

SMALLEST_PART = 2.0**-8
MOST_PARTS = 400


@dataclass(frozen=True)
class Advance:
    """How one load step ended.

    Attributes
    ----------
    state, value
        Last state of equilibrium and its load value (N or m).
    iterations
        Newton corrections in all parts together.
    cuts
        How often a part was halved.
    reason
        Why the target was not reached, or "".
    """

    state: State
    value: float
    iterations: int
    cuts: int
    reason: str = ""


class Stepper:
    """Follows the equilibrium from load to load.

    Parameters
    ----------
    problem
        The equations.
    control
        What is prescribed, force (N) or depth (m).
    force_scale
        Force in N below which the tolerance is not tightened further.
    settings
        Limits of each Newton run.
    start
        State without force to start from; None for rest.
    """

    def __init__(
        self,
        problem: Equilibrium,
        control: Literal["force", "depth"],
        force_scale: float,
        settings: NewtonSettings,
        start: State | None = None,
    ) -> None:
        self._problem = problem
        self._control: Literal["force", "depth"] = control
        self._force_scale = force_scale
        self._settings = settings
        self._state = State(*problem.system.rest(), 0.0) if start is None else start
        self._value = 0.0 if control == "force" else problem.depth(self._state.y)
        self._known = KnownStates(self._value, self._state)

    @property
    def known(self) -> KnownStates:
        """All states of equilibrium found so far."""
        return self._known

    def resume(self, values: FloatArray, states: Sequence[State]) -> None:
        """Go on from the last of known states, each with its load value (k,) in N or m."""
        self._value, self._state = float(values[-1]), states[-1]
        self._known = KnownStates(float(values[0]), states[0])
        for value, state in zip(values[1:].tolist(), states[1:], strict=True):
            self._known.add(value, state)

    def advance(self, target: float) -> Advance:
        """Go to the load value `target`, halving the way as often as needed."""
        start, iterations, cuts = self._value, 0, 0
        way = part = target - start
        for _ in range(MOST_PARTS):
            value = target if abs(part) >= abs(target - self._value) else self._value + part
            guess = self._known.predict(value)
            result = solve_newton(self._problem, guess, self._control, value, self._force_scale, self._settings)
            iterations += result.iterations
            if result.success:
                self._state, self._value = result.state, value
                self._known.add(value, result.state)
                if value == target:
                    return Advance(self._state, value, iterations, cuts)
                part *= 2.0
            else:
                part *= 0.5
                cuts += 1
                if abs(part) <= SMALLEST_PART * abs(way):
                    return Advance(self._state, self._value, iterations, cuts, result.reason)
        return Advance(self._state, self._value, iterations, cuts, f"more than {MOST_PARTS} parts of one step")
