"""Oscillators of a solid whose stiffness fades: each a damped pair and one lag a Prony term, exactly.

With inertia, damping and a Prony series an oscillator of natural frequency w answers a force by 1 / f(s),

    f(s) = s^2 / w^2 + c s / w^2 + 1 - sum_j g_j / (1 + s tau_j),    c = mass_rate + stiffness_time w^2.

Below each rate r_j = 1 / tau_j lies at least one real pole -lambda_j; the two that are left follow from the sum and the
product of all, without cancellation: s^2 + (c + sum (r_j - lambda_j)) s + w^2 (1 - sum g_j) prod (r_j / lambda_j).
In partial fractions the real poles are lags and the pair is an oscillator without fading, of which position and
speed are read. Without a series the pair is the oscillator itself.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.damping import Damping
from wavemodel.integrators.lag import LagStep, lag_step
from wavemodel.integrators.oscillators import OscillatorStep, pair_step
from wavemodel.integrators.prony import Prony

HALVINGS = 200
CLOSE = 1e-15
"""The search for a pole stops when its bracket is so small (relatively)."""


@dataclass(frozen=True)
class Poles:
    """Partial fractions of N oscillators.

    Attributes
    ----------
    frequency, drag
        (N,) of the pair: w and c of `pair_step`.
    position, speed
        (N,) weights of its position and of its speed over w.
    rate, weight
        (J, N) of the lags, 1/s and 1.
    """

    frequency: FloatArray
    drag: FloatArray
    position: FloatArray
    speed: FloatArray
    rate: FloatArray
    weight: FloatArray


def poles(frequency: FloatArray, damping: Damping, series: Prony) -> Poles:
    """Split oscillators of natural frequencies (N,), rad/s."""
    strength, rate = series.ordered
    drag = damping.mass_rate + damping.stiffness_time * frequency**2
    found = _real_rates(frequency, drag, strength, rate)
    apart = rate[:, None] - found
    pair_drag = drag + apart.sum(axis=0)
    pair = frequency * np.sqrt(series.long_term * np.prod(rate[:, None] / found, axis=0))
    slope = (drag - 2.0 * found) / frequency**2
    slope = slope + np.einsum("j,jin->in", strength * rate, (rate[:, None, None] - found) ** -2.0)
    weight = 1.0 / (found * slope)
    position = 1.0 / series.long_term - weight.sum(axis=0)
    return Poles(pair, pair_drag, position, -(weight * found).sum(axis=0) / pair, found, weight)


def _real_rates(frequency: FloatArray, drag: FloatArray, strength: FloatArray, rate: FloatArray) -> FloatArray:
    """(J, N) one root lambda of f(-lambda) between each rate and the one before it, by halving."""
    low = np.broadcast_to(np.concatenate([[0.0], rate])[:-1, None], (rate.size, frequency.size)).copy()
    high = np.broadcast_to(rate[:, None], low.shape).copy()
    for _ in range(HALVINGS if rate.size else 0):
        middle = 0.5 * (low + high)
        fading = np.einsum("j,jin->in", strength * rate, 1.0 / (rate[:, None, None] - middle))
        above = (middle - drag) * middle / frequency**2 + 1.0 - fading > 0.0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
        if np.all(high - low <= CLOSE * high):
            break
    return 0.5 * (low + high)


class Motion:
    """State of N oscillators under one force, and the coefficients of the latest step length.

    Parameters
    ----------
    frequency
        (N,) angular, rad/s.
    damping, series
        Of all of them.
    """

    def __init__(self, frequency: FloatArray, damping: Damping, series: Prony) -> None:
        self._poles = poles(frequency, damping, series)
        self._static = 1.0 / series.long_term
        self._pair, self._speed = np.zeros_like(frequency), np.zeros_like(frequency)
        self._lags = np.zeros_like(self._poles.rate)

    @property
    def displacement(self) -> FloatArray:
        """(N,) in units of the initial static answer to one newton."""
        return self._combine(self._pair, self._speed, self._lags)

    def rest(self, force: float) -> None:
        """Take the static state that a force leaves after a long time."""
        self._pair[:], self._speed[:], self._lags[:] = force, 0.0, force

    def prepare(self, duration: float) -> None:
        """Coefficients of steps of `duration`, s."""
        p = self._poles
        self._step: OscillatorStep = pair_step(p.frequency, p.drag, duration)
        self._lag: LagStep = lag_step(p.rate * duration)

    def advance(self, before: float, change: float) -> None:
        """Go one step whose force goes linearly from `before` to `before + change`."""
        self._step.advance(self._pair, self._speed, before, change)
        self._lags *= self._lag.keep
        self._lags += (1.0 - self._lag.keep) * before + self._lag.last * change

    def free(self) -> FloatArray:
        """(N,) displacement at the end of a step without force."""
        step = self._step
        moved = step.stay * self._pair + step.swing * self._speed
        speed = step.settle * self._speed - step.swing * self._pair
        return self._combine(moved, speed, self._lag.keep * self._lags)

    def gain(self) -> FloatArray:
        """(N,) displacement that a constant force of one within a step adds at its end."""
        step = self._step
        return self._combine(1.0 - step.stay, step.swing, 1.0 - self._lag.keep)

    def _combine(self, pair: FloatArray, speed: FloatArray, lags: FloatArray) -> FloatArray:
        p = self._poles
        out: FloatArray = p.position * pair + p.speed * speed + np.einsum("jn,jn->n", p.weight, lags)
        return out
