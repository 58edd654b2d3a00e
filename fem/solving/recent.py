"""Prediction of the next state of a body with a memory, from the last states.

The states of the way up say nothing about the way back. While the load goes on at one rate the last three states are
extrapolated over time; after a change of rate the last increment is scaled with the load.
"""

from __future__ import annotations

import numpy as np

from fem.solving.predictor import combined, lagrange
from fem.solving.state import State

KEPT = 3
SAME_RATE = 1e-6


class RecentStates:
    """The last states of equilibrium with load value and time of each."""

    def __init__(self, value: float, time: float, state: State) -> None:
        self._known = [(value, time, state)]

    def add(self, value: float, time: float, state: State) -> None:
        """Remember a state."""
        self._known = [*self._known[1 - KEPT :], (value, time, state)]

    def predict(self, value: float, time: float) -> State:
        """State at a load value and a time in s."""
        values = np.array([*(v for v, _, _ in self._known), value])
        times = np.array([*(t for _, t, _ in self._known), time])
        states = [state for _, _, state in self._known]
        if len(states) == 1:
            return states[0]
        steps, durations = np.diff(values), np.diff(times)
        if len(states) == KEPT and durations.min() > 0.0 and _steady(steps / durations):
            return combined(lagrange(times[:-1], time), states)
        ratio = steps[-1] / steps[-2] if steps[-2] != 0.0 else 0.0
        return combined(np.array([-ratio, 1.0 + ratio]), states[-2:])


def _steady(rates: np.ndarray) -> bool:
    return bool(np.ptp(rates) <= SAME_RATE * np.abs(rates).max())
