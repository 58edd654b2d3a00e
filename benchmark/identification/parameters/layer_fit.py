"""The fit of parameters to the trials of one or several presses: Gauss-Newton on surrogates that are solved anew.

In each round the model presses every set-up with the values that were reached; trials are fitted on the surrogates,
their noise (autocorrelated) and the scatter of their gains are estimated from what the fit leaves, and the round is the
last where the model, pressed anew, agrees with the surrogate that led there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from benchmark.errors import SolverError
from benchmark.identification.parameters.free_parameters import (
    COMMON,
    RELAXATION,
    SHARE,
    Parameter,
    start_vector,
)
from benchmark.identification.parameters.layer_model import GAIN, Fading, FitTrial, ForceTable, LayerModel
from benchmark.identification.parameters.mixed_effects import SpreadParts, renoised, spread_parts
from benchmark.identification.parameters.press_atlas import PressAtlas
from benchmark.identification.parameters.press_surrogate import Forward, Press, PressSurrogate, StopsError, surrogate
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import Search, TrialsFit, least_squares
from benchmark.response.noise import whitener

MODEL_TRUST = 0.005
"""Standard deviation of the model's own error in a press, in size and in slope over depth, as shares of the force.

What finite-element codes and meshes that people use differ by on the same press: 0.4 to 0.8 % in size and 0.1 to 0.2 %
in shape between meshes of another code, three layers under sharp tools; our own meshes differ by 0.1 to 0.2 %.
"""
FIRST_NOISE, FIRST_MEMORY = 0.01, 0.6
USUAL_SCATTER = 0.015
"""Standard deviation of trials' gains to begin with, and where there are too few trials to tell it."""
WEAK = 2.0
"""Standard deviation of a free parameter's logarithm round its start (sevenfold): it stops what no data hold."""
FARTHEST = 0.7
"""How far a coordinate may go in a round: twofold."""
AGREES = 5e-4
"""Largest difference of surrogate and model, as a share of the force, with which a round is the last."""
MOST_ROUNDS = 6
RETRIES = 4
LEAST_REACH, SAFE_REACH = 0.5, 0.95
"""A press that the model follows to half its depth at least is fitted to this share of what it follows."""
SEARCH = Search(most=25, gain=1e-3, share=1e-7)
LOOKED_UP = Search(most=0)

Say = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class FitProblem:
    """What is fitted.

    Attributes
    ----------
    presses : tuple of Press
    trials : tuple of FitTrial
    parameters : tuple of Parameter
        Free ones, and told ones with their uncertainty as prior.
    law : str or None
        Law that all layers get; None keeps the specimen's own.
    forward : "fem" or "wave"
    trust : float
        Standard deviation of the model's own error, a share of the force.
    specimens : tuple of str
        The specimen of each trial, where several were tried repeatedly; empty where that is not told.
    """

    presses: tuple[Press, ...]
    trials: tuple[FitTrial, ...]
    parameters: tuple[Parameter, ...]
    law: str | None = None
    forward: Forward = "fem"
    trust: float = MODEL_TRUST
    specimens: tuple[str, ...] = ()

    @property
    def free(self) -> tuple[int, ...]:
        """Numbers of the free parameters."""
        return tuple(k for k, one in enumerate(self.parameters) if not one.told)

    @property
    def size(self) -> int:
        """Coordinates of the fit: parameters, and the model's own error in each press."""
        return len(self.parameters) + 2 * len(self.presses)

    @property
    def freedom(self) -> int:
        """Trials beyond those that settle the level of each press: what tells their scatter."""
        used = {trial.press for trial in self.trials}
        return len(self.trials) - min(len(used), len(self.free))


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
        return self.disagreement <= AGREES

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
        """Standard errors on either side of a 95 % interval: Student's t with the freedom of trials or specimens."""
        spread, freedom = self.spread, self.problem.freedom
        if spread is not None:
            return spread.inflation * float(scipy.stats.t.ppf(0.975, spread.specimens - 1))
        return float(scipy.stats.t.ppf(0.975, freedom)) if freedom > 0 else 1.96

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
    start = np.concatenate([start_vector(problem.parameters), np.zeros(2 * len(problem.presses))])
    problem, surrogates = _followed(problem, start)
    model = _first_model(problem, surrogates, start)
    nuisance = np.column_stack([1e3 * touches, zeros, np.zeros(len(problem.trials))])
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
        At most; with none the trials are fitted on the surrogates of the start.
    """
    problem, model, nuisance = start.problem, start.model, start.fit.nuisance
    vector, apart, done = start.vector, np.inf, 0
    for done in range(1, rounds + 1):
        model, fit, memory = _fitted(problem, model, vector, nuisance)
        pressed, vector = _pressed_anew(problem, fit.vector, vector)
        apart = disagreement(model.surrogates, pressed, vector)
        say(f"round {done}: model and surrogate differ by {100 * apart:.2g} % of the force")
        stopped = _at_edge(problem, model, fit.vector)
        model, nuisance = _renewed(problem, model, pressed, vector), fit.nuisance
        if apart <= AGREES and not stopped:
            break
    model, fit, memory = _fitted(problem, model, vector, nuisance)
    return LayerFit(problem, fit, memory, done, apart)


def _followed(problem: FitProblem, start: Array) -> tuple[FitProblem, tuple[PressSurrogate, ...]]:
    """The presses where a fit begins, as deep as the model follows them, with the trials' rows so deep."""
    surrogates = []
    for number in range(len(problem.presses)):
        for _ in range(RETRIES):
            try:
                surrogates.append(_surrogate(problem, number, start))
                break
            except StopsError as stop:
                if stop.reach < LEAST_REACH * problem.presses[number].depth:
                    raise
                problem = _shallower(problem, number, SAFE_REACH * stop.reach)
        else:
            surrogates.append(_surrogate(problem, number, start))
    return problem, tuple(surrogates)


def _shallower(problem: FitProblem, number: int, depth: float) -> FitProblem:
    """The problem with one press less deep."""
    press = replace(problem.presses[number], depth=depth)
    presses = (*problem.presses[:number], press, *problem.presses[number + 1 :])
    trials = tuple(one.up_to(depth) if one.press == number else one for one in problem.trials)
    return replace(problem, presses=presses, trials=trials)


def _first_model(problem: FitProblem, surrogates: tuple[PressSurrogate, ...], start: Array) -> LayerModel:
    """The model where the fit begins, with noise that nobody has estimated yet."""
    mean, precision = _priors(problem)
    noise = np.array([FIRST_NOISE * np.ptp(one.data.force) for one in problem.trials])
    white = tuple(whitener(one.count, FIRST_MEMORY) for one in problem.trials)
    limits = _limits(problem, start)
    fading = _fading(problem)
    atlases = tuple(PressAtlas((one,), _curved(problem, k)) for k, one in enumerate(surrogates))
    return LayerModel(
        atlases, problem.trials, fading, limits, mean, precision, USUAL_SCATTER, white, np.maximum(noise, 1e-9)
    )


def _curved(problem: FitProblem, number: int) -> NDArray[np.int64]:
    """Coordinates in which a press' log force is no straight line."""
    press = problem.presses[number]
    chosen = (k for k, one in enumerate(problem.parameters) if press.has(one) and not one.fading and one.key != COMMON)
    return np.array(list(chosen), dtype=np.int64)


def press_all(problem: FitProblem, vector: Array) -> tuple[PressSurrogate, ...]:
    """All presses at coordinates (p,), with the model's own error; raises SolverError or InputError."""
    return tuple(_surrogate(problem, number, vector) for number in range(len(problem.presses)))


def _surrogate(problem: FitProblem, number: int, vector: Array) -> PressSurrogate:
    press, count = problem.presses[number], len(problem.parameters)
    relaxing = [name for name in _relaxing(problem) if name in press.setup[0].layer_names]
    found = surrogate(press, problem.parameters, vector[:count], problem.law, relaxing, problem.forward)
    own = np.zeros((2 * len(problem.presses), found.depth.size))
    own[2 * number] = 1.0
    own[2 * number + 1] = np.linspace(-1.0, 1.0, found.depth.size)
    at = np.concatenate([found.at, np.zeros(own.shape[0])])
    return replace(found, by=np.vstack([found.by, own]), at=at)


def _relaxing(problem: FitProblem) -> tuple[str, ...]:
    """Layers that fade by parameters of their own."""
    ends = (one.key.removesuffix(SHARE) for one in problem.parameters if one.key.endswith(SHARE))
    return tuple(dict.fromkeys(ends))


def _fading(problem: FitProblem) -> tuple[Fading, ...]:
    """Where each press finds shares and times of what fades in it."""
    out = []
    for number, press in enumerate(problem.presses):
        for k, one in enumerate(problem.parameters):
            if one.key.endswith((SHARE, f"{RELAXATION}.g")) and press.has(one):
                layer = one.key.removesuffix(SHARE) if one.key.endswith(SHARE) else ""
                out.append(Fading(number, layer, k, k + 1))
    return tuple(out)


def _priors(problem: FitProblem) -> tuple[Array, Array]:
    """Mean and precision (p,) of the coordinates' priors."""
    mean, precision = np.zeros(problem.size), np.full(problem.size, problem.trust**-2)
    for k, one in enumerate(problem.parameters):
        value, deviation = (one.start, WEAK) if one.prior is None else (one.prior.value, one.prior.deviation)
        mean[k], precision[k] = one.coordinate(value), deviation**-2
    return mean, precision


def _limits(problem: FitProblem, vector: Array) -> tuple[Array, Array]:
    """Bounds of the next round round a point."""
    ends = [one.limits for one in problem.parameters] + [(-0.1, 0.1)] * (2 * len(problem.presses))
    low, high = np.array(ends).T
    return np.maximum(low, vector - FARTHEST), np.minimum(high, vector + FARTHEST)


def _fitted(
    problem: FitProblem, model: LayerModel, vector: Array, nuisance: Array
) -> tuple[LayerModel, TrialsFit[LayerModel], float]:
    """The trials fitted on the surrogates at hand, with noise and scatter from what the fit leaves."""
    fit = least_squares(model, vector, nuisance, search=SEARCH)
    memory = 0.0
    for _ in range(3):
        model, memory = renoised(fit, problem.freedom)
        fit = least_squares(model, fit.vector, fit.nuisance, search=SEARCH)
    return model, fit, memory


def _pressed_anew(problem: FitProblem, vector: Array, before: Array) -> tuple[tuple[PressSurrogate, ...], Array]:
    """All presses at new coordinates, or nearer to the old ones where the model does not follow them."""
    for _ in range(RETRIES):
        try:
            return press_all(problem, vector), vector
        except SolverError:
            vector = 0.5 * (vector + before)
    return press_all(problem, before), before


def disagreement(old: Sequence[ForceTable], new: Sequence[PressSurrogate], vector: Array) -> float:
    """Largest difference of the force that the old tables foretold and the new one, as a share."""
    deep = slice(old[0].depth.size // 8, None)
    count = new[0].at.size
    own = np.where(np.arange(count) < count - 2 * len(new), vector, 0.0)
    return max(
        float(np.abs(np.log(one.force_at(own)[deep] / two.force[deep])).max())
        for one, two in zip(old, new, strict=True)
    )


def _at_edge(problem: FitProblem, model: LayerModel, vector: Array) -> bool:
    """Whether a coordinate was held by the round's own limits, and not by its bounds."""
    low, high = np.array([one.limits for one in problem.parameters]).T
    own = vector[: low.size]
    held_low = (own <= model.limits[0][: low.size]) & (own > low)
    held_high = (own >= model.limits[1][: low.size]) & (own < high)
    return bool((held_low | held_high).any())


def _renewed(problem: FitProblem, model: LayerModel, pressed: tuple[PressSurrogate, ...], vector: Array) -> LayerModel:
    return replace(model, surrogates=joined(model.surrogates, pressed), limits=_limits(problem, vector))


def joined(tables: Sequence[ForceTable], pressed: Sequence[PressSurrogate]) -> tuple[ForceTable, ...]:
    """Tables with one more press each."""
    pairs = zip(tables, pressed, strict=True)
    return tuple(one.with_press(new) if isinstance(one, PressAtlas) else new for one, new in pairs)
