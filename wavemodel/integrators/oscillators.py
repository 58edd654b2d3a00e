"""Damped oscillators, with or without relaxation, under a force that is linear within each step, exactly.

u'' / w^2 + c u' / w^2 + u = F(t) with v = u' / w; c = mass_rate + stiffness_time w^2. The linear force has the
particular solution u_p = F - c F' / w^2, v_p = F' / w; what is left over is free and moves by

    [ a        d w   ]     a = e^(-s h) (cos(p h) + s sin(p h) / p)
    [ -d w   a - c d ]     d = e^(-s h) sin(p h) / p,    s = c / 2,  p^2 = w^2 - s^2,

or its overdamped form, written with decaying exponentials only: nothing overflows for rates from 1 to 1e10 per
second, and without damping the step is a rotation.

With a Prony series too an oscillator answers a force by 1 / f(s),

    f(s) = s^2 / w^2 + c s / w^2 + 1 - sum_j g_j / (1 + s tau_j).

Below each rate r_j = 1 / tau_j lies at least one real pole -lambda_j; the two that are left follow from the sum and the
product of all, without cancellation: s^2 + (c + sum (r_j - lambda_j)) s + w^2 (1 - sum g_j) prod (r_j / lambda_j).
In partial fractions the real poles are lags and the pair is an oscillator without relaxation, of which position and
speed are read. Without a series the pair is the oscillator itself.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.lags import LagStep, lag_step
from wavemodel.integrators.viscoelastic import Damping, Prony

HALVINGS = 200
CLOSE = 1e-15
"""The search for a pole stops when its bracket is so small (relatively)."""


@dataclass(frozen=True)
class OscillatorStep:
    """Coefficients of one step for N oscillators.

    Attributes
    ----------
    stay, swing, settle
        (N,) a, d w and a - c d.
    drag
        (N,) c / (w^2 h): u_p = F - drag (F_{n+1} - F_n).
    pace
        (N,) 1 / (w h): v_p = pace (F_{n+1} - F_n).
    """

    stay: FloatArray
    swing: FloatArray
    settle: FloatArray
    drag: FloatArray
    pace: FloatArray

    def advance(self, u: FloatArray, v: FloatArray, before: float, change: float) -> None:
        """Move u and v (N,) in place over a step whose force goes from `before` to `before + change`."""
        shift = before - self.drag * change
        u -= shift
        v -= self.pace * change
        moved = self.stay * u + self.swing * v
        v *= self.settle
        v -= self.swing * u
        v += self.pace * change
        np.add(moved, shift + change, out=u)


def oscillator_step(frequency: FloatArray, drag: FloatArray, duration: float) -> OscillatorStep:
    """Coefficients for angular frequencies w (N,) in rad/s and a duration in s, above zero, and rates c (N,) in 1/s."""
    half = 0.5 * drag
    inner = (frequency - half) * (frequency + half)
    cosine, sine = np.empty_like(frequency), np.empty_like(frequency)
    under = inner > 0.0
    cosine[under], sine[under] = _swinging(frequency[under], half[under], np.sqrt(inner[under]), duration)
    over = ~under
    cosine[over], sine[over] = _creeping(frequency[over], half[over], np.sqrt(-inner[over]), duration)
    lean = half / frequency
    return OscillatorStep(
        stay=cosine + lean * sine,
        swing=sine,
        settle=cosine - lean * sine,
        drag=drag / (frequency**2 * duration),
        pace=1.0 / (frequency * duration),
    )


def _swinging(
    frequency: FloatArray, half: FloatArray, turning: FloatArray, duration: float
) -> tuple[FloatArray, FloatArray]:
    """e^(-s h) cos(p h) and d w where s < w; without damping a pure rotation, w / p being one."""
    decay, turn = np.exp(-half * duration), turning * duration
    return decay * np.cos(turn), decay * np.sin(turn) * (frequency / turning)


def _creeping(
    frequency: FloatArray, half: FloatArray, root: FloatArray, duration: float
) -> tuple[FloatArray, FloatArray]:
    """The same where s >= w, by the slow exponential and how much of it the fast one takes away."""
    slow = np.exp(-(frequency**2) / (half + root) * duration)
    fade = -np.expm1(-2.0 * root * duration)
    spread = np.divide(fade, 2.0 * root, out=np.full_like(root, duration), where=root > 0.0)
    return slow * (1.0 - 0.5 * fade), slow * spread * frequency


@dataclass(frozen=True)
class Poles:
    """Partial fractions of N oscillators.

    Attributes
    ----------
    frequency, drag
        (N,) of the pair: w and c of `oscillator_step`.
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
    drag = damping.drag(frequency)
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
        relaxed = np.einsum("j,jin->in", strength * rate, 1.0 / (rate[:, None, None] - middle))
        above = (middle - drag) * middle / frequency**2 + 1.0 - relaxed > 0.0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
        if np.all(high - low <= CLOSE * high):
            break
    return 0.5 * (low + high)


class OscillatorMotion:
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
        self._step: OscillatorStep = oscillator_step(p.frequency, p.drag, duration)
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
