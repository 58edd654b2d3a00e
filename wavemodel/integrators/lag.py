"""First-order lag, time x' + x = F: creep of a Kelvin-Voigt solid, and the piece that all fading memory is made of."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray, NumberArray
from wavemodel.integrators.scan import fading_sum


@dataclass(frozen=True)
class LagStep:
    """x+ = keep x + first F_n + last F_{n+1}, exact for a force linear within the step.

    Attributes
    ----------
    keep, first, last
        Numbers, or arrays with one entry a lag.
    """

    keep: NumberArray
    first: NumberArray
    last: NumberArray


def lag_step(ratio: NumberArray) -> LagStep:
    """Coefficients for steps of `ratio` = duration / time, not negative; a step without duration keeps x."""
    keep = np.exp(-ratio)
    mean = np.divide(-np.expm1(-ratio), ratio, out=np.ones_like(ratio), where=ratio != 0.0)
    return LagStep(keep, mean - keep, 1.0 - mean)


def lagged(ratio: NumberArray, force: FloatArray, last: float = 0.0, start: float = 0.0) -> NumberArray:
    """(n,) response x to a force that is linear within each step.

    Parameters
    ----------
    ratio
        (n,) durations of the steps over the lag's time.
    force
        (n,) at the ends of the steps.
    last, start
        Force and response before the first step.
    """
    step = lag_step(ratio)
    before = np.concatenate([[last], force[:-1]])
    return fading_sum(ratio, step.first * before + step.last * force, start)
