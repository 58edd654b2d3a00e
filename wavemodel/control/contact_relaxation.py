"""Relaxation of each contact while it is held, and how the surface comes back when the tool is gone.

Held, the force is f = e - sum_j y_j + eta e' with tau_j y_j' = g_j e - y_j, exact for an elastic force e linear in each
frame. Free, f = 0: without damping the surface springs to e = sum_j y_j at once and creeps on from there.
"""

import numpy as np
from scipy.linalg import expm

from wavemodel.arrays import FloatArray
from wavemodel.errors import require_not_negative
from wavemodel.integrators.lags import free_motion, lag_end, relaxation
from wavemodel.integrators.viscoelastic import Prony


class ContactRelaxation:
    """State of `contacts` contacts.

    Parameters
    ----------
    contacts
        How many.
    series
        Relaxation of the tissue.
    retardation
        Kelvin-Voigt time, s.

    Raises
    ------
    WaveError
        If the time is negative or not finite.
    """

    def __init__(self, contacts: int, series: Prony, retardation: float) -> None:
        require_not_negative("retardation", retardation, "s")
        self._strength, self._rate = series.ordered
        self._series, self._eta, count = series, retardation, self._strength.size
        # y_j, then e, as plain numbers: a series has a few terms, which arrays would only slow down.
        self._state = [[0.0] * (count + 1) for _ in range(contacts)]
        self._steps: list[tuple[float, float, float]] = []
        self._free, self._dt = np.zeros((count + 1, count + 1)), 0.0

    def held(self, contact: int, elastic: float, dt: float) -> float:
        """Force after a frame in which the elastic force went to a value, N."""
        self._prepare(dt)
        state = self._state[contact]
        before, force = state[-1], elastic
        for j, (keep, first, last) in enumerate(self._steps):
            lag = keep * state[j] + first * before + last * elastic
            state[j] = lag
            force -= lag
        state[-1] = elastic
        return force + self._eta * (elastic - before) / dt

    def let_go(self, contact: int, dt: float) -> float:
        """Elastic force after a frame at whose end the held contact answers with none: where the surface stands, N."""
        self._prepare(dt)
        state = self._state[contact]
        before, jump = state[-1], self._eta / dt
        offset, gain = lag_end(before, state[:-1], self._steps)
        return (offset + jump * before) / (1.0 + jump - gain)

    def fade(self, contact: int, share: float) -> None:
        """Keep a share of what a contact remembers."""
        self._state[contact] = [share * part for part in self._state[contact]]

    def free(self, contact: int, dt: float) -> float:
        """Elastic force after a frame without a force on the surface, N."""
        self._prepare(dt)
        state = self._state[contact]
        state[:] = (self._free @ state).tolist()
        return state[-1]

    def forget(self, contact: int) -> None:
        """Back to the untouched tissue."""
        self._state[contact] = [0.0] * len(self._state[contact])

    def _prepare(self, dt: float) -> None:
        if dt == self._dt:
            return
        ratio = self._rate * dt
        keep = np.exp(-ratio)
        mean = -np.expm1(-ratio) / ratio
        parts = keep, self._strength * (mean - keep), self._strength * (1.0 - mean)
        self._steps = list(zip(*(part.tolist() for part in parts), strict=True))
        self._free[:] = self._released(dt)
        self._dt = dt

    def _released(self, dt: float) -> FloatArray:
        """(J + 1, J + 1) from the state (y, e) at the last instant to that after a frame."""
        matrix, row = free_motion([(relaxation(self._series), self._rate)], self._eta)
        count, moved = self._strength.size, expm(matrix * dt)
        whole = np.zeros((count + 1, count + 1))
        if self._eta:
            whole[:] = moved
        else:
            whole[:count, :count], whole[-1, :count] = moved, row @ moved
        scale = np.append(self._strength, 1.0)
        return np.asarray(scale[:, None] * whole / scale)
