"""First-order lag, eta x' + x = F: the Kelvin-Voigt creep that all of a stiffness-damped body's statics share."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray


@dataclass(frozen=True)
class LagStep:
    """x+ = keep x + first F_n + last F_{n+1}, exact for a force linear within the step."""

    keep: float
    first: float
    last: float


def lag_step(duration: float, lag: float) -> LagStep:
    """Coefficients for a step of `duration` (s) at a lag time (s); without lag x is the force itself."""
    if duration == 0.0 and lag > 0.0:
        return LagStep(1.0, 0.0, 0.0)
    if lag == 0.0:
        return LagStep(0.0, 0.0, 1.0)
    ratio = duration / lag
    mean = -np.expm1(-ratio) / ratio
    return LagStep(float(np.exp(-ratio)), float(mean - np.exp(-ratio)), float(1.0 - mean))


def lagged(durations: FloatArray, force: FloatArray, lag: float) -> FloatArray:
    """(n,) response x to a force (n,) that starts from zero; static at a first step without duration."""
    if lag == 0.0:
        return force.copy()
    out = np.empty_like(force)
    before, x = 0.0, 0.0
    for n, duration in enumerate(durations):
        if n == 0 and duration == 0.0:
            x = float(force[0])
        else:
            step = lag_step(float(duration), lag)
            x = step.keep * x + step.first * before + step.last * float(force[n])
        out[n], before = x, float(force[n])
    return out
