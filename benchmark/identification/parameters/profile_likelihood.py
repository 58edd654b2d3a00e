"""Intervals by profile likelihood: how far a parameter may go while all others make up for it.

-2 log of the likelihood ratio, the other parameters and the trials' nuisances at their best, is pressed up to the
square of the quantile (Venzon and Moolgavkar 1988, Applied Statistics 37:87). Profiles are worked out on tables of
presses; where an end lies away from all of them the model is pressed there and the profile is drawn again, so that an
interval is that of the model and not of its slope at the estimate.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmark.errors import SolverError
from benchmark.identification.parameters.fit_problem import ERROR_LIMITS
from benchmark.identification.parameters.identifiability import KNOWN, errors_alone
from benchmark.identification.parameters.layer_fit import LayerFit, knowing
from benchmark.identification.parameters.pressed_set_ups import joined, press_all
from benchmark.identification.parameters.presses.press_atlas import PressAtlas
from benchmark.identification.parameters.presses.press_surrogate import PressSurrogate
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import Search, least_squares

SHARES = (0.25, 0.5, 0.75)
"""Of the way to each end of the interval, where the curve is drawn beside the ends themselves."""
TURNS = 14
REFIT = Search(most=12, gain=0.01, share=0.0)
"""A refit ends where a step lowers -2 log likelihood by less than 0.02: an end of an interval is at 3.8 or more."""
TRUSTED = 0.25
"""How far from a press its table is trusted: a modulus a quarter off is foretold within 0.03 % of the force."""
TURNS_OF_PRESSES = 3
CLOSE = 0.03
"""Relative error of the square root of the rise at which an end of an interval is found."""


@dataclass(frozen=True, eq=False)
class Profile:
    """The profile of one parameter.

    Attributes
    ----------
    coordinate, rise : (m,) array
        The coordinate, and -2 log of the likelihood ratio there.
    errors : (m, f) array
        Standard errors of all free coordinates by the trials alone, where the refits ended.
    low, high : float
        Ends of the 95 % interval of the coordinate; infinite where it does not end within reach.
    quantile : float
        Its square is the rise at the ends.
    """

    coordinate: Array
    rise: Array
    errors: Array
    low: float
    high: float
    quantile: float

    def determined(self, at: float) -> bool:
        """Whether the interval ends within a factor of two of the estimate, either way."""
        return max(self.high - at, at - self.low) <= KNOWN


def verified_profiles(
    found: LayerFit, others: Sequence[LayerFit] = ()
) -> tuple[LayerFit, tuple[LayerFit, ...], tuple[Profile, ...]]:
    """Profiles of all free coordinates whose ends were pressed, with the fit and its others on the richer tables."""
    answers = (found, *others)
    walks = {k: _walks(answers, k) for k in found.problem.free}
    for _ in range(TURNS_OF_PRESSES):
        ends = [walk.ended(sign) for each in walks.values() for walk in each for sign in (-1.0, 1.0)]
        new = _pressed_at(answers[0], ends)
        if not new:
            break
        for pressed in new:
            answers = tuple(knowing(one, joined(one.model.surrogates, pressed)) for one in answers)
        walks = {k: _walks(answers, k, walks[k]) for k in found.problem.free}
    return answers[0], answers[1:], tuple(_drawn(each) for each in walks.values())


def _pressed_at(found: LayerFit, ends: Sequence[Array]) -> list[tuple[PressSurrogate, ...]]:
    """Presses at ends that lie away from all presses, and from each other; where the model stops an end is left."""
    tables, out = found.model.surrogates, []
    for end in ends:
        if max(one.away(end) for one in tables if isinstance(one, PressAtlas)) <= TRUSTED:
            continue
        at = end.copy()
        at[len(found.problem.parameters) :] = 0.0
        try:
            pressed = press_all(found.problem, at)
        except SolverError:
            continue
        tables = joined(tables, pressed)
        out.append(pressed)
    return out


def profile(found: LayerFit, index: int, others: Sequence[LayerFit] = ()) -> Profile:
    """The profile of one coordinate of a fit; `others` follow the trials as well, and widen the interval."""
    return _drawn(_walks((found, *others), index))


def largest_errors(profiles: Sequence[Profile]) -> Array:
    """(f,) largest standard error of each free coordinate by the trials alone, in all that 95 % of confidence holds."""
    held = [one.errors[one.rise <= ((1.0 + CLOSE) * one.quantile) ** 2] for one in profiles]
    return np.asarray(np.max([errors.max(axis=0) for errors in held], axis=0))


def _walks(answers: Sequence[LayerFit], index: int, before: Sequence[_Walk] = ()) -> tuple[_Walk, ...]:
    """Walks to both ends of a coordinate's interval round each answer, as high as the best one's allows."""
    best, out = answers[0], []
    quantile = best.quantile_of(index)
    for number, one in enumerate(answers):
        walk = _Walk(one, index, quantile, max(2.0 * (one.fit.objective - best.fit.objective), 0.0))
        spread = math.sqrt(max(float(one.fit.covariance[index, index]), 1e-12))
        for sign in (-1.0, 1.0):
            told = before[number].reach(sign) if before else min(walk.wanted * spread, 2.0 * KNOWN)
            walk.to_end(sign, told)
        out.append(walk)
    return tuple(out)


def _drawn(walks: Sequence[_Walk]) -> Profile:
    """The curve of all walks together, with points between the estimates and the ends."""
    points: list[tuple[float, float, Array]] = []
    for walk in walks:
        for sign in (-1.0, 1.0):
            for share in SHARES:
                walk.rise(walk.start + sign * share * walk.reach(sign))
        points += [(at, rise + walk.lost, walk.errors[at]) for at, rise in walk.known.items()]
    points.sort(key=lambda each: each[0])
    coordinate, rise, errors = (np.array(column) for column in zip(*points, strict=True))
    low, high = min(walk.ends[-1.0] for walk in walks), max(walk.ends[1.0] for walk in walks)
    return Profile(coordinate, rise, errors, low, high, walks[0].quantile)


class _Walk:
    """Refits of a model with one coordinate held, each begun where its neighbour ended.

    What nobody knows beforehand of a free parameter narrows nothing: the weak priors that steady the fit are left out.

    `lost` is how much worse than the best the answer is, in -2 log likelihood; `wanted` the root of the rise at an end.
    """

    def __init__(self, found: LayerFit, index: int, quantile: float, lost: float):
        self._found, self._index, self.lost, self.quantile = found, index, lost, quantile
        self.wanted = max(math.sqrt(max(quantile**2 - lost, 0.0)), 1e-3)
        ends = [one.limits for one in found.problem.parameters]
        count = found.vector.size - len(ends)
        low, high = np.array([*ends, *[ERROR_LIMITS] * count]).T
        told = found.model.prior_precision.copy()
        told[[k for k in found.problem.free if found.problem.parameters[k].prior is None]] = 0.0
        unsaid = np.sum((found.model.prior_precision - told) * (found.vector - found.model.prior_mean) ** 2)
        self._misfit = found.fit.objective - 0.5 * float(unsaid)
        self._model = replace(found.model.within(low, high), prior_precision=told)
        self._limits = float(low[index]), float(high[index])
        self.start = float(found.vector[index])
        self.known = {self.start: 0.0}
        self.errors = {self.start: errors_alone(found.fit, found.problem.free)}
        self._states = {self.start: (found.vector, found.fit.nuisance)}
        self._last = {-1.0: self.start, 1.0: self.start}
        self.ends = {-1.0: -math.inf, 1.0: math.inf}
        column = found.fit.covariance[:, index]
        self._along = column / max(float(column[index]), 1e-300)

    def ended(self, sign: float) -> Array:
        """(p,) all coordinates where the walk ended on one side."""
        return self._states[self._last[sign]][0]

    def reach(self, sign: float) -> float:
        """How far from the estimate the walk ended on one side."""
        return abs(self._last[sign] - self.start)

    def rise(self, value: float) -> float:
        """-2 log of the likelihood ratio with the coordinate at a value."""
        near = min(self._states, key=lambda each: abs(each - value))
        vector, nuisance = self._states[near]
        vector = np.clip(vector + (value - near) * self._along, *self._model.limits)
        vector[self._index] = value
        fit = least_squares(self._model.fixed_at(self._index, value), vector, nuisance, search=REFIT)
        self.known[value] = max(2.0 * (fit.objective - self._misfit), 0.0)
        self.errors[value] = errors_alone(fit, self._found.problem.free)
        self._states[value] = fit.vector, fit.nuisance
        return self.known[value]

    def to_end(self, sign: float, step: float) -> None:
        """Go to where the rise comes to the quantile's square, if it does within reach.

        The root of the rise is close to straight: steps along it, then regula falsi (Illinois' form, which also comes
        to an end where the rise is steep, such as where another parameter stands at its bound).
        """
        bound = self._limits[1] if sign > 0.0 else self._limits[0]
        reach = min(abs(bound - self.start), 3.0 * KNOWN)
        below, above = (0.0, -self.wanted), (math.inf, math.inf)
        at, side = min(max(step, 1e-6), reach), 0.0
        for _ in range(TURNS):
            self._last[sign] = self.start + sign * at
            short = math.sqrt(self.rise(self._last[sign])) - self.wanted
            if abs(short) <= CLOSE * self.wanted:
                break
            if short < 0.0 and at >= reach:
                return
            below, above = ((at, short), above) if short < 0.0 else (below, (at, short))
            if not math.isfinite(above[0]):
                slope = max((short + self.wanted) / at, 1e-9)
                at = min(max(1.1 * at, min(self.wanted / slope, 3.0 * at)), reach)
                continue
            if side == math.copysign(1.0, short):
                below, above = (below, (above[0], above[1])) if short < 0.0 else ((below[0], 0.5 * below[1]), above)
                above = (above[0], 0.5 * above[1]) if short < 0.0 else above
            side = math.copysign(1.0, short)
            at = below[0] + (above[0] - below[0]) * below[1] / (below[1] - above[1])
        self.ends[sign] = self._last[sign]
