"""From a Prony series and a Kelvin-Voigt time to creep: the same solid driven by force instead of depth.

With the transform G(s) = 1 - sum_j g_j / (1 + s tau_j) + eta s of force over depth, creep is 1 / G(s). Its poles lie
one below each rate 1 / tau_j (and with eta one above the fastest); each adds a lag of weight 1 / (lambda G'(-lambda)),
all positive (B. Gross, Mathematical Structure of the Theories of Viscoelasticity, 1953).
"""

from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from wavemodel.arrays import FloatArray
from wavemodel.integrators.lag_sum import LagSum
from wavemodel.integrators.prony import Prony


def relaxation(series: Prony, retardation: float = 0.0) -> LagSum:
    """Force over initial stiffness, driven by depth.

    Parameters
    ----------
    series
        Fading memory.
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
