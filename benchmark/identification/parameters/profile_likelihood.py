"""Intervals by profile likelihood: how far a parameter may go while all others make up for it.

-2 log of the likelihood ratio, the other parameters and the trials' nuisances at their best, is pressed up to the
square of the quantile (Venzon and Moolgavkar 1988, Applied Statistics 37:87). On the surrogates of the solution no
model is pressed again.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmark.identification.parameters.layer_fit import SEARCH, LayerFit
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import least_squares

KNOWN = math.log(2.0)
"""A parameter is determined where its interval ends within a factor of two, either way. Wider is said to be unknown."""
SHARES = (0.3, 0.6)
"""Of the way to each end of the interval, where the curve is drawn beside the ends themselves."""
TURNS = 6
CLOSE = 0.03
"""Relative error of the square root of the rise at which an end of an interval is found."""


@dataclass(frozen=True, eq=False)
class Profile:
    """The profile of one parameter.

    Attributes
    ----------
    coordinate, rise : (m,) array
        The coordinate, and -2 log of the likelihood ratio there.
    low, high : float
        Ends of the 95 % interval of the coordinate; infinite where it does not end within reach.
    """

    coordinate: Array
    rise: Array
    low: float
    high: float

    def determined(self, at: float) -> bool:
        """Whether the interval ends within a factor of two of the estimate, either way."""
        return max(self.high - at, at - self.low) <= KNOWN


def profile(found: LayerFit, index: int, others: Sequence[LayerFit] = ()) -> Profile:
    """The profile of one coordinate of a fit; `others` follow the trials as well, and widen the interval."""
    own = _around(found, index, found.quantile)
    if not others:
        return own
    parts = [own]
    for other in others:
        lost = max(2.0 * (other.fit.objective - found.fit.objective), 0.0)
        part = _around(other, index, math.sqrt(max(found.quantile**2 - lost, 0.0)))
        parts.append(replace(part, rise=part.rise + lost))
    points = np.array(sorted((x, y) for part in parts for x, y in zip(part.coordinate, part.rise, strict=True)))
    low, high = min(part.low for part in parts), max(part.high for part in parts)
    return Profile(points[:, 0], points[:, 1], low, high)


def _around(found: LayerFit, index: int, wanted: float) -> Profile:
    """The profile round one answer, to where the root of the rise is as wanted."""
    walk = _Walk(found, index, wanted)
    spread = math.sqrt(max(float(found.fit.covariance[index, index]), 1e-12))
    low, high = (walk.end(sign, min(wanted * spread, 2.0 * KNOWN)) for sign in (-1.0, 1.0))
    at = float(found.vector[index])
    for end in (low, high):
        reach = (end if math.isfinite(end) else at + math.copysign(2.0 * KNOWN, end)) - at
        for share in SHARES:
            walk.rise(at + share * reach)
    points = np.array(sorted(walk.known.items()))
    return Profile(points[:, 0], points[:, 1], low, high)


class _Walk:
    """Refits of a model with one coordinate held, each begun where its neighbour ended."""

    def __init__(self, found: LayerFit, index: int, wanted: float):
        self._found, self._index, self._wanted = found, index, max(wanted, 1e-3)
        ends = [one.limits for one in found.problem.parameters]
        count = found.vector.size - len(ends)
        low, high = np.array([*ends, *[(-0.1, 0.1)] * count]).T
        self._model = found.model.within(low, high)
        self._limits = float(low[index]), float(high[index])
        self.known = {float(found.vector[index]): 0.0}
        self._states = {float(found.vector[index]): (found.vector, found.fit.nuisance)}

    def rise(self, value: float) -> float:
        """-2 log of the likelihood ratio with the coordinate at a value."""
        near = min(self._states, key=lambda each: abs(each - value))
        vector, nuisance = self._states[near]
        vector = vector.copy()
        vector[self._index] = value
        fit = least_squares(self._model.fixed_at(self._index, value), vector, nuisance, search=SEARCH)
        self.known[value] = max(2.0 * (fit.objective - self._found.fit.objective), 0.0)
        self._states[value] = fit.vector, fit.nuisance
        return self.known[value]

    def end(self, sign: float, step: float) -> float:
        """Where the rise comes to the quantile's square; infinite where it does not within reach.

        The root of the rise is close to straight: regula falsi on it.
        """
        start, wanted = float(self._found.vector[self._index]), self._wanted
        bound = self._limits[1] if sign > 0.0 else self._limits[0]
        reach = min(abs(bound - start), 3.0 * KNOWN)
        inner, inner_root, outer = 0.0, 0.0, min(step, reach)
        for _ in range(TURNS):
            root = math.sqrt(self.rise(start + sign * outer))
            if abs(root - wanted) <= CLOSE * wanted:
                return start + sign * outer
            if root < wanted:
                if outer >= reach:
                    return sign * math.inf
                inner, inner_root = outer, root
                slope = max(root / outer, 1e-9)
                outer = min(max(1.1 * outer, min(wanted / slope, 3.0 * outer)), reach)
            else:
                share = (wanted - inner_root) / (root - inner_root)
                outer = inner + min(max(share, 0.05), 0.95) * (outer - inner)
        return start + sign * outer
