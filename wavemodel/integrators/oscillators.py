"""Damped oscillators under a force that is linear within each step, exactly.

u'' / w^2 + c u' / w^2 + u = F(t) with v = u' / w; c = mass_rate + stiffness_time w^2. The linear force has the
particular solution u_p = F - c F' / w^2, v_p = F' / w; what is left over is free and moves by

    [ a        d w   ]     a = e^(-s h) (cos(p h) + s sin(p h) / p)
    [ -d w   a - c d ]     d = e^(-s h) sin(p h) / p,    s = c / 2,  p^2 = w^2 - s^2,

or its overdamped form, written with decaying exponentials only: nothing overflows for rates from 1 to 1e10 per
second, and without damping the step is a rotation.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.damping import Damping


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


def oscillator_step(frequency: FloatArray, damping: Damping, duration: float) -> OscillatorStep:
    """Coefficients for angular frequencies (N,) in rad/s, above zero, and a duration (s) above zero."""
    return pair_step(frequency, damping.mass_rate + damping.stiffness_time * frequency**2, duration)


def pair_step(frequency: FloatArray, rate: FloatArray, duration: float) -> OscillatorStep:
    """The same for any rates c (N,), 1/s."""
    half = 0.5 * rate
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
        drag=rate / (frequency**2 * duration),
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
