"""The fit of parameters to the trials of one or several presses: Gauss-Newton on surrogates that are solved anew.

In each round the model presses every set-up with the values that were reached; trials are fitted on the surrogates,
their noise (autocorrelated) and the scatter of their gains are estimated from what the fit leaves, and the round is the
last where the model, pressed anew, agrees with the surrogate that led there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy

from benchmark.identification.parameters.fit_problem import (
    FitProblem,
    curved_coordinates,
    fading_of,
    priors,
    round_limits,
)
from benchmark.identification.parameters.layer_model import GAIN, FilmNoise, ForceTable, LayerModel
from benchmark.identification.parameters.mixed_effects import SpreadParts, renoised, spread_parts
from benchmark.identification.parameters.pressed_set_ups import disagreement, followed, joined, pressed_anew
from benchmark.identification.parameters.presses.marker_rings import MarkerRows
from benchmark.identification.parameters.presses.press_atlas import PressAtlas
from benchmark.identification.parameters.presses.press_surrogate import PressSurrogate
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import Search, TrialsFit, least_squares, scaled_inverse
from benchmark.response.noise import whitener

FIRST_NOISE, FIRST_MEMORY = 0.01, 0.0
FIRST_FILM_NOISE = 1e-5
"""m."""
USUAL_SCATTER = 0.015
"""Standard deviation of trials' gains to begin with, and where there are too few trials to tell it."""
SLOW_ROUNDS = 6
"""Rounds after which a fit goes on only while each leaves no more than `NEARING` of what the one before left."""
MOST_ROUNDS = 20
NEARING = 0.5
SEARCH = Search(most=25, gain=1e-3, share=1e-7)
LOOKED_UP = Search(most=0)
NORMAL = 1.96
LEAST_SHARE = 1e-3
"""Share of a variance below which what makes it counts as known."""

Say = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class LayerFit:
    """A fit of parameters.

    Attributes
    ----------
    problem : FitProblem
    fit : TrialsFit of LayerModel
        At the solution, on surrogates that were pressed there.
    memory : float
        Correlation of the noise of neighbouring rows.
    rounds : int
    disagreement : float
        Largest difference of the last surrogate and the model pressed anew, a share of the force.
    """

    problem: FitProblem
    fit: TrialsFit[LayerModel]
    memory: float
    rounds: int
    disagreement: float

    @property
    def settled(self) -> bool:
        """Whether model and surrogate agree where the fit ended."""
        return self.disagreement <= self.problem.agrees

    @property
    def model(self) -> LayerModel:
        """What was fitted, with its noise."""
        return self.fit.model

    @property
    def vector(self) -> Array:
        """(p,) coordinates."""
        return self.fit.vector

    def value(self, index: int) -> float:
        """The value of a parameter, SI."""
        return self.problem.parameters[index].value(float(self.vector[index]))

    @property
    def quantile(self) -> float:
        """Standard errors on either side of 95 % of what the gains scatter: Student's t of trials or specimens."""
        spread, freedom = self.spread, self.problem.freedom
        if spread is not None:
            return spread.inflation * float(scipy.stats.t.ppf(0.975, spread.specimens - 1))
        return float(scipy.stats.t.ppf(0.975, freedom)) if freedom > 0 else NORMAL

    def quantile_of(self, index: int) -> float:
        """Standard errors on either side of a coordinate's 95 % interval.

        Of its variance the share s is that of the gains' scatter, which n degrees of freedom tell, and the rest is
        known: Student's t with n / s^2 (Satterthwaite 1946, Biometrics Bulletin 2:110).
        """
        spread, freedom = self.spread, self.problem.freedom
        if spread is None and freedom < 1:
            return NORMAL
        inflation, freedom = (1.0, freedom) if spread is None else (spread.inflation, spread.specimens - 1)
        known = min(float(self._with_known_gains[index] / self.fit.covariance[index, index]), 1.0)
        grown = known + inflation**2 * (1.0 - known)
        share = max(1.0 - known / grown, LEAST_SHARE)
        return math.sqrt(grown) * float(scipy.stats.t.ppf(0.975, freedom / share**2))

    @cached_property
    def _with_known_gains(self) -> Array:
        """(p,) variances of the coordinates if the trials' gains were known."""
        weight = np.diag(np.delete(self.model.trial_precision, GAIN))
        total = np.diag(self.fit.precision)
        for by, nuisances in zip(self.fit.columns.vector, self.fit.columns.nuisance, strict=True):
            others = np.delete(nuisances, GAIN, axis=1)
            across = others.T @ by
            total = total + by.T @ by - across.T @ np.linalg.pinv(others.T @ others + weight, hermitian=True) @ across
        return np.diag(scaled_inverse(total))

    @property
    def spread(self) -> SpreadParts | None:
        """Scatter between specimens and between their trials; None where specimens are not told apart."""
        named = self.problem.specimens
        return spread_parts(self.fit.nuisance[:, GAIN], named) if named else None

    @property
    def predicted(self) -> list[Array]:
        """Force (n,) N of each trial."""
        return self.model.predicted(self.vector, self.fit.nuisance)


def begun(problem: FitProblem, touches: Array, zeros: Array) -> LayerFit:
    """Press all set-ups where a fit begins; nothing is fitted yet, and the noise is a usual one.

    Parameters
    ----------
    problem : FitProblem
    touches, zeros : (R,) array
        Where each trial touches (m) and its force without contact (N), to begin with.

    Raises
    ------
    SolverError
        The model does not follow the presses.
    """
    start = problem.start
    problem, surrogates = followed(problem, start)
    model = _first_model(problem, surrogates, start)
    nuisance = np.column_stack([1e3 * touches, zeros, np.zeros((len(problem.trials), 1 + model.rings))])
    nuisance[:, 0] = np.clip(nuisance[:, 0], model.trial_bounds[0][:, 0], model.trial_bounds[1][:, 0])
    fit = least_squares(model, start, nuisance, search=LOOKED_UP)
    return LayerFit(problem, fit, FIRST_MEMORY, 0, np.inf)


def knowing(found: LayerFit, tables: Sequence[ForceTable]) -> LayerFit:
    """The fit on other tables, first order round its own presses."""
    model = replace(found.model, surrogates=tuple(map(_round, found.model.surrogates, tables)))
    return replace(found, fit=least_squares(model, found.vector, found.fit.nuisance, search=SEARCH))


def _round(own: ForceTable, table: ForceTable) -> ForceTable:
    """A table whose newest press is that of another one."""
    return table.with_press(own.newest) if isinstance(own, PressAtlas) and isinstance(table, PressAtlas) else table


def fit_layers(start: LayerFit, say: Say = lambda _: None, rounds: int = MOST_ROUNDS) -> LayerFit:
    """Fit parameters.

    Parameters
    ----------
    start : LayerFit
        From `begun`, or of an earlier fit.
    say : callable
        Told of each round.
    rounds : int
        At most, and of more than `SLOW_ROUNDS` only as many as come nearer; with none the trials are fitted on the
        surrogates of the start.
    """
    problem, model, nuisance = start.problem, start.model, start.fit.nuisance
    vector, apart, done = start.vector, np.inf, 0
    for done in range(1, rounds + 1):
        before = apart
        model, fit, memory = _fitted(problem, model, vector, nuisance)
        pressed, vector = pressed_anew(problem, fit.vector, vector)
        apart = disagreement(model.surrogates, pressed, vector, len(problem.parameters))
        say(f"round {done}: model and surrogate differ by {100 * apart:.2g} % of the force")
        stopped = _at_edge(problem, model, fit.vector)
        model, nuisance = _renewed(problem, model, pressed, vector), fit.nuisance
        if (apart <= problem.agrees and not stopped) or (done >= SLOW_ROUNDS and apart > NEARING * before):
            break
    model, fit, memory = _fitted(problem, model, vector, nuisance)
    return LayerFit(problem, fit, memory, done, apart)


def _first_model(problem: FitProblem, surrogates: tuple[PressSurrogate, ...], start: Array) -> LayerModel:
    """The model where the fit begins, with noise that nobody has estimated yet."""
    mean, precision = priors(problem)
    noise = np.array([FIRST_NOISE * np.ptp(one.data.force) for one in problem.trials])
    white = tuple(whitener(one.count, FIRST_MEMORY) for one in problem.trials)
    limits = round_limits(problem, start)
    fading = fading_of(problem)
    atlases = tuple(PressAtlas((one,), curved_coordinates(problem, k)) for k, one in enumerate(surrogates))
    films = tuple(None if one.film is None else _usual_film(one.film) for one in problem.trials)
    noise, films = np.maximum(noise, 1e-9), films if problem.rings else ()
    return LayerModel(atlases, problem.trials, fading, limits, mean, precision, USUAL_SCATTER, white, noise, films)


def _usual_film(film: MarkerRows) -> FilmNoise:
    return FilmNoise(whitener(film.count, FIRST_MEMORY), np.full(film.moved.shape[1], FIRST_FILM_NOISE))


def _fitted(
    problem: FitProblem, model: LayerModel, vector: Array, nuisance: Array
) -> tuple[LayerModel, TrialsFit[LayerModel], float]:
    """The trials fitted on the surrogates at hand, with noise and scatter from what the fit leaves.

    The noise's memory is that of what ordinary least squares leave. Estimated again from a fit with memory it may hold
    itself up: such a fit is off where the depth has noise, and what it is off by has the memory.
    """
    plain = replace(model, white=tuple(whitener(one.count, 0.0) for one in model.trials))
    fit = least_squares(plain, vector, nuisance, search=SEARCH)
    model, memory = renoised(fit, problem.freedom)
    fit = least_squares(model, fit.vector, fit.nuisance, search=SEARCH)
    for _ in range(2):
        model, memory = renoised(fit, problem.freedom, memory)
        fit = least_squares(model, fit.vector, fit.nuisance, search=SEARCH)
    return model, fit, memory


def _at_edge(problem: FitProblem, model: LayerModel, vector: Array) -> bool:
    """Whether a coordinate was held by the round's own limits, and not by its bounds."""
    low, high = np.array([one.limits for one in problem.parameters]).T
    own = vector[: low.size]
    held_low = (own <= model.limits[0][: low.size]) & (own > low)
    held_high = (own >= model.limits[1][: low.size]) & (own < high)
    return bool((held_low | held_high).any())


def _renewed(problem: FitProblem, model: LayerModel, pressed: tuple[PressSurrogate, ...], vector: Array) -> LayerModel:
    return replace(model, surrogates=joined(model.surrogates, pressed), limits=round_limits(problem, vector))
