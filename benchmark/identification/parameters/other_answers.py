"""Other answers: minima away from the one that was found which follow the trials as well.

Force over depth under one tool may have the same shape for two specimens, so that sensitivities at either are sharp and
yet neither is known. The fit is begun again on both sides of what was found, along the directions that are known least.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmark.errors import SolverError
from benchmark.identification.parameters.identifiability import directions
from benchmark.identification.parameters.layer_fit import SEARCH, LayerFit, fit_layers, restarted
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import least_squares

AWAY = 1.0
"""How far from an answer the fit is begun again: a factor of e along the direction."""
SURE = 0.04
"""A direction that is told to this standard error is not tried. First choice."""
MOST_TRIED = 2
SAME = 0.5
"""Answers that differ by less than so many standard errors in all free parameters are one."""
ROUNDS = 3


def other_answers(found: LayerFit, say: Callable[[str], None]) -> tuple[LayerFit, tuple[LayerFit, ...]]:
    """The best answer, and those that the trials do not tell from it (95 %), with the same noise and scatter."""
    answers = [found]
    for direction in directions(found)[:MOST_TRIED]:
        if direction.deviation < SURE:
            continue
        for sign in (-1.0, 1.0):
            other = _begun_again(found, sign * AWAY * _whole(found, direction.parts), say)
            if other is not None and not any(_same(other, one) for one in answers):
                answers.append(other)
    best = min(answers, key=lambda one: one.fit.objective)
    return best, tuple(one for one in answers if one is not best and behind(one, best) <= best.quantile**2)


def behind(other: LayerFit, best: LayerFit) -> float:
    """How much worse an answer follows the trials, in -2 log likelihood."""
    return max(2.0 * (other.fit.objective - best.fit.objective), 0.0)


def _begun_again(found: LayerFit, step: Array, say: Callable[[str], None]) -> LayerFit | None:
    """Another fit from a step away, in the noise of the first; None where the model does not follow it."""
    try:
        other = fit_layers(restarted(found, found.vector + step), say, ROUNDS)
    except SolverError:
        return None
    own = found.model
    model = replace(other.model, white=own.white, noise=own.noise, gain_deviation=own.gain_deviation)
    return replace(other, fit=least_squares(model, other.vector, other.fit.nuisance, search=SEARCH))


def _whole(found: LayerFit, parts: Array) -> Array:
    """(p,) a direction of the free parameters among all coordinates."""
    out = np.zeros(found.vector.size)
    out[list(found.problem.free)] = parts
    return out


def _same(one: LayerFit, other: LayerFit) -> bool:
    free = list(one.problem.free)
    spread = np.sqrt(np.maximum(np.diag(other.fit.covariance)[free], 1e-12))
    return bool((np.abs(one.vector[free] - other.vector[free]) <= SAME * spread).all())
