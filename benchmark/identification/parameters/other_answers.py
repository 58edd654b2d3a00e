"""Other answers: minima away from the one that was found which follow the trials as well.

Force over depth under one tool may have the same shape for two specimens, so that sensitivities at either are sharp and
yet neither is known. The model is pressed on both sides of what was found, along the directions that are known least;
on the tables that know these presses the fit is begun again from each, and where it ends elsewhere the model is pressed
there, too. A parameter of either sign is fitted from both, and the better fit goes on.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmark.errors import SolverError
from benchmark.identification.parameters.fit_problem import ERROR_LIMITS, round_limits
from benchmark.identification.parameters.free_parameters import Parameter
from benchmark.identification.parameters.identifiability import directions
from benchmark.identification.parameters.layer_fit import SEARCH, LayerFit, fit_layers, knowing
from benchmark.identification.parameters.layer_model import LayerModel
from benchmark.identification.parameters.pressed_set_ups import disagreement, joined, press_all
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import TrialsFit, least_squares

AWAYS = (1.0, 2.0)
"""How far from an answer the fit is begun again: factors of e and of e squared along the direction.

Under one tool two skins whose moduli were 2.8, 3.9 and 0.4 times each other's had the same force: begun at e alone the
fit fell back.
"""
SURE = 0.04
"""A direction that is told to this standard error is not tried. First choice."""
MOST_TRIED = 2
SAME = 0.5
"""Answers that differ by less than so many standard errors in all free parameters are one."""
ROUNDS = 4
LATELY = 4.0
"""An answer is pursued while -2 log likelihood is so much above what cannot be told from the best."""


def other_answers(found: LayerFit, say: Callable[[str], None]) -> tuple[LayerFit, tuple[LayerFit, ...]]:
    """The best answer, and those that the trials do not tell from it (95 %), with the same noise and scatter."""
    found, starts = _better_sign(found, say)
    for step in _steps(found):
        explored_fit, at = _explored(found, found.vector + step)
        if at is not None:
            found, starts = explored_fit, [*starts, at]
    answers = [found]
    for at in starts:
        other = _pursued(answers, at, say)
        if other is not None:
            answers = [knowing(one, other.model.surrogates) for one in answers]
            answers.append(other)
    best = min(answers, key=lambda one: one.fit.objective)
    rest = [one for one in answers if one is not best and behind(one, best) <= best.quantile**2]
    return best, tuple(one for one in rest if not _same(one, best))


def behind(other: LayerFit, best: LayerFit) -> float:
    """How much worse an answer follows the trials, in -2 log likelihood."""
    return max(2.0 * (other.fit.objective - best.fit.objective), 0.0)


def _better_sign(found: LayerFit, say: Callable[[str], None]) -> tuple[LayerFit, list[Array]]:
    """The better of the fits that begin on either side of none, and where the other one ended.

    The second one begins where the first did, with what is of either sign as far on the other side; where the bounds
    or the model hold none of that the fit stays as it is.
    """
    problem, begin = found.problem, found.problem.start.copy()
    low, high = limits(problem.parameters, begin.size)
    signed = [k for k in problem.free if problem.parameters[k].signed]
    begin[signed] = np.clip(-np.copysign(begin[signed], found.vector[signed]), low[signed], high[signed])
    if (begin[signed] * found.vector[signed] >= 0.0).all():
        return found, []
    explored, at = _explored(found, begin)
    if at is None:
        return found, []
    say("the other sign")
    low, high = round_limits(problem, at)
    other = replace(explored, fit=replace(explored.fit, vector=at, model=explored.model.within(low, high)))
    other = fit_layers(other, say)
    best, rest = sorted((explored, other), key=_likelihood)
    return knowing(best, rest.model.surrogates), [rest.vector]


def _likelihood(found: LayerFit) -> float:
    """-2 log likelihood of trials and gains, each fit with the noise and the scatter that it found."""
    model = found.model
    size = len(model.trials) * math.log(model.gain_deviation)
    for white, noise in zip(model.white, model.noise, strict=True):
        size += float(np.log(white.scale * noise).sum())
    for film in (film for film in model.film_noise if film is not None):
        size += float(np.log(np.outer(film.whitener.scale, film.deviation)).sum())
    return 2.0 * (found.fit.objective + size)


def _steps(found: LayerFit) -> list[Array]:
    """Steps (p,) to where the model is pressed."""
    weak = [one for one in directions(found)[:MOST_TRIED] if one.deviation >= SURE]
    return [sign * away * _whole(found, one.parts) for away in AWAYS for one in weak for sign in (-1.0, 1.0)]


def _explored(found: LayerFit, vector: Array) -> tuple[LayerFit, Array | None]:
    """The fit with a press at coordinates (p,), or half way there, and where that was; None where the model stops."""
    low, high = limits(found.problem.parameters, vector.size)
    for share in (1.0, 0.5):
        at = np.clip(found.vector + share * (vector - found.vector), low, high)
        at[len(found.problem.parameters) :] = 0.0
        try:
            pressed = press_all(found.problem, at)
        except SolverError:
            continue
        return knowing(found, joined(found.model.surrogates, pressed)), at
    return found, None


def limits(parameters: tuple[Parameter, ...], size: int) -> tuple[Array, Array]:
    """Bounds (p,) of all coordinates, those of the model's own error last."""
    ends = [one.limits for one in parameters]
    low, high = np.array([*ends, *[ERROR_LIMITS] * (size - len(ends))]).T
    return low, high


def _pursued(answers: list[LayerFit], at: Array, say: Callable[[str], None]) -> LayerFit | None:
    """Another answer that begins at coordinates (p,), pressed anew where it ends; None where there is none."""
    best = min(answers, key=lambda one: one.fit.objective)
    model = best.model.within(*limits(best.problem.parameters, at.size))
    nuisance = best.fit.nuisance
    for turn in range(1, ROUNDS + 1):
        fit = least_squares(model, at, nuisance, search=SEARCH)
        other = replace(best, fit=fit, rounds=turn, disagreement=np.inf)
        if any(_same(other, one) for one in answers) or behind(other, best) > best.quantile**2 + LATELY:
            return None
        try:
            pressed = press_all(best.problem, fit.vector)
        except SolverError:
            return None
        apart = disagreement(model.surrogates, pressed, fit.vector, len(best.problem.parameters))
        say(f"another answer, round {turn}: model and surrogate differ by {100 * apart:.2g} % of the force")
        model, at, nuisance = replace(model, surrogates=joined(model.surrogates, pressed)), fit.vector, fit.nuisance
        if apart <= best.problem.agrees:
            return _ended(other, model, apart)
    return _ended(other, model, apart)


def _ended(other: LayerFit, model: LayerModel, apart: float) -> LayerFit:
    fit: TrialsFit[LayerModel] = least_squares(model, other.vector, other.fit.nuisance, search=SEARCH)
    return replace(other, fit=fit, disagreement=apart)


def _whole(found: LayerFit, parts: Array) -> Array:
    """(p,) a direction of the free parameters among all coordinates."""
    out = np.zeros(found.vector.size)
    out[list(found.problem.free)] = parts
    return out


def _same(one: LayerFit, other: LayerFit) -> bool:
    free = list(one.problem.free)
    spread = np.sqrt(np.maximum(np.diag(other.fit.covariance)[free], 1e-12))
    return bool((np.abs(one.vector[free] - other.vector[free]) <= SAME * spread).all())
