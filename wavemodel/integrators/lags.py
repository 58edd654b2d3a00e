"""First-order lags, time x' + x = F, and the linear answers that are sums of them: relaxation and creep.

With the transform G(s) = 1 - sum_j g_j / (1 + s tau_j) + eta s of force over depth (a Prony series and a Kelvin-Voigt
time eta), creep is 1 / G(s): the same solid driven by force instead of depth. Its poles lie one below each rate
1 / tau_j (and with eta one above the fastest); each adds a lag of weight 1 / (lambda G'(-lambda)), all positive
(B. Gross, Mathematical Structure of the Theories of Viscoelasticity, 1953).
"""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from wavemodel.arrays import FloatArray, NumberArray
from wavemodel.integrators.scan import decaying_sum
from wavemodel.integrators.viscoelastic import Prony


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
    lost = -np.expm1(-ratio)
    mean = np.divide(lost, ratio, out=np.ones_like(ratio), where=ratio != 0.0)
    return LagStep(1.0 - lost, mean - (1.0 - lost), 1.0 - mean)


def lagged(ratio: NumberArray, force: FloatArray, last: float = 0.0, start: NumberArray | float = 0.0) -> NumberArray:
    """(..., n) responses x to a force that is linear within each step.

    Parameters
    ----------
    ratio
        (..., n) durations of the steps over the lags' times.
    force
        (n,) at the ends of the steps.
    last
        Force before the first step.
    start
        (...) responses before the first step.
    """
    step = lag_step(ratio)
    before = np.concatenate([[last], force[:-1]])
    return decaying_sum(ratio, step.first * before + step.last * force, start)


@dataclass(frozen=True)
class LagSum:
    """out = instant F + rate F' + sum_i weight_i x_i with time_i x_i' + x_i = F; exact for F linear in each step.

    Attributes
    ----------
    instant
        Factor of what comes in at once.
    weight, time
        (m,) of the lags; times in s.
    rate
        Factor of the slope within the step that ends, s.
    """

    instant: float
    weight: FloatArray
    time: NumberArray
    rate: float = 0.0

    @property
    def static(self) -> float:
        """The answer to one, after a long time."""
        return float(self.instant + self.weight.sum())

    def lags(self, durations: FloatArray, values: FloatArray, memory: "LagMemory | None" = None) -> NumberArray:
        """(m, n) responses of the lags to values (n,) at the ends of steps (n,), s."""
        memory = memory or self.rest()
        return lagged(durations / self.time[:, None], values, memory.last, memory.state)

    def follow(
        self, durations: FloatArray, values: FloatArray, memory: "LagMemory | None" = None
    ) -> tuple[FloatArray, "LagMemory"]:
        """(n,) answer to values (n,) at the ends of steps (n,), s, and the memory to go on from.

        Parameters
        ----------
        durations
            Of the steps, s. Where there is none the value jumps and the lags stay.
        values
            What comes in.
        memory
            None: at rest.
        """
        memory = memory or self.rest()
        state = self.lags(durations, values, memory)
        out = self.instant * values + self.weight @ state
        if self.rate:
            out += self.rate * slopes(durations, values, memory.last)
        return out, LagMemory(float(values[-1]), state[:, -1])

    def rest(self, value: float = 0.0) -> "LagMemory":
        """Memory of having been at one value for ever."""
        return LagMemory(value, np.full(self.time.size, value))


@dataclass(frozen=True)
class LagMemory:
    """Where a `LagSum` stands: what came in last and its (m,) lags."""

    last: float
    state: FloatArray


def slopes(durations: FloatArray, values: FloatArray, last: float) -> FloatArray:
    """(n,) slope within each step; zero where a step has no duration."""
    change = np.diff(values, prepend=last)
    return np.divide(change, durations, out=np.zeros_like(change), where=durations > 0.0)


def relaxation(series: Prony, retardation: float = 0.0) -> LagSum:
    """Force over initial stiffness, driven by depth.

    Parameters
    ----------
    series
        Relaxation.
    retardation
        Kelvin-Voigt time eta, s.
    """
    strength, rate = series.ordered
    return LagSum(1.0, -strength, 1.0 / rate, retardation)


@lru_cache(maxsize=256)
def creep(series: Prony, retardation: float = 0.0) -> LagSum:
    """Depth over initial compliance, driven by force: the inverse of `relaxation`."""
    roots = np.array(_rates(series, retardation))
    strength, rate = series.ordered
    slope = retardation + (strength * rate / (rate - roots[:, None]) ** 2).sum(axis=1)
    weight = 1.0 / (roots * slope)
    return LagSum(0.0 if retardation else 1.0, weight, 1.0 / roots)


def _rates(series: Prony, retardation: float) -> list[float]:
    """Rates lambda of creep, rising: G(-lambda) = 0."""
    strength, rate = series.ordered

    def transform(root: float) -> float:
        return float(1.0 - retardation * root - (strength * rate / (rate - root)).sum())

    edges: FloatArray = np.concatenate([[0.0], rate])
    brackets = [(low + _gap(low), high - _gap(high)) for low, high in pairwise(edges)]
    if retardation:
        fastest = (edges[-1] + 1.0 / retardation) * (2.0 + strength.sum())
        brackets.append((edges[-1] + _gap(edges[-1]), fastest))
    return [brentq(transform, low, high, xtol=1e-300, rtol=1e-15) for low, high in brackets]


def _gap(rate: float) -> float:
    return 1e-12 * rate
