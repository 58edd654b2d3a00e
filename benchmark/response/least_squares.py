"""One engine of least squares: damped Gauss-Newton for many trials that share a vector of parameters.

Each trial may have nuisances of its own, which are eliminated in closed form: the trials meet in the vector alone, so
that the normal matrix is an arrow. Priors are normal; bounds are kept by stopping what would leave them while the
others make up for it. What a trial says of the vector, after its nuisances, is kept as its block; the blocks also give
the covariance, the fit without a trial and the density of a trial at other parameters, to second order.

No library eliminates nuisances trial by trial (SciPy's `least_squares` and lmfit would carry all of them in one dense
matrix); a single record without nuisances is the case of one trial (`RecordModel`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from benchmark.response.force_curve import Array
from benchmark.response.normal_equations import TrialEquations, bounded_step, joint_step, stepped, trial_equations
from benchmark.response.trials_model import RecordModel, TrialColumns, TrialsEvaluation, TrialsModel

MOST_DAMPING, UNDAMPED = 1e5, 1.0
"""Damping at which a fit gives up, and beyond which the trials' own values follow a step of the vector each by itself:
then it must be their steps, which that damping leaves alone, that keep the objective from falling."""
LENT = 6
"""Steps for which the derivatives of a start serve."""


@dataclass(frozen=True)
class Search:
    """How a fit goes on, and when it has converged.

    Attributes
    ----------
    most : int
        Steps at most; with none the start is only looked up.
    gain, share : float
        It has converged where a step lowers the objective by less than `gain`, or by this share of it.
    damping : float
        Of the diagonal of the normal matrix, to begin with; a step that lowers the objective takes it to a fifth.
    """

    most: int = 12
    gain: float = 0.03
    share: float = 3e-5
    damping: float = 1e-3


USUAL = Search()
SETTLED = Search(most=20, gain=1e-3, share=1e-6)
"""Of the nuisances of a trial at parameters that stay."""
EXACT = Search(most=200, gain=0.0, share=1e-13, damping=1.0)
"""Of a few bounded parameters: to round-off, and in short steps first, since a long one may end in a corner."""


Model = TypeVar("Model", bound=TrialsModel)
Fitted = TypeVar("Fitted", bound=TrialsModel, covariant=True)


@dataclass(frozen=True, eq=False)
class Blocks:
    """What each of R trials says of the vector (p,) after its nuisances.

    Attributes
    ----------
    matrix : (R, p, p), slope : (R, p)
        Half the misfit is constant - slope . step + step . matrix . step / 2.
    misfit : (R,)
        Sum of squares of the white residual, its nuisances at their best.
    log_size : (R,)
        Logarithm of the determinant that marginalising the nuisances adds.
    """

    matrix: Array
    slope: Array
    misfit: Array
    log_size: Array


@dataclass(frozen=True, eq=False)
class TrialsFit(Generic[Fitted]):
    """A model fitted.

    Attributes
    ----------
    model
        What was fitted.
    vector : (p,) array
    nuisance : (R, q) array
    objective : float
        Half the sum of squares with all priors.
    blocks : Blocks
        At the solution.
    precision, prior_mean : (p,) array
        Of the priors on the vector.
    columns : TrialColumns
        At the solution.
    converged : bool
        Whether it ended before its steps did.
    """

    model: Fitted
    vector: Array
    nuisance: Array
    objective: float
    blocks: Blocks
    precision: Array
    prior_mean: Array
    columns: TrialColumns
    converged: bool = True

    @property
    def covariance(self) -> Array:
        """(p, p) of the vector, for residuals of unit variance."""
        total = self.blocks.matrix.sum(axis=0) + np.diag(self.precision)
        return scaled_inverse(total)

    def without(self, trials: NDArray[np.bool_]) -> Array:
        """(p,) of the fit without some trials (mask (R,)), to first order, within the bounds."""
        matrix = self.blocks.matrix[~trials].sum(axis=0) + np.diag(self.precision)
        slope = self.blocks.slope[~trials].sum(axis=0) - self.precision * (self.vector - self.prior_mean)
        low, high = self.model.bounds
        step = bounded_step(matrix, slope, (low - self.vector, high - self.vector), 1e-9)
        return stepped(self.vector, step, (low, high))

    def log_density(self, vector: Array) -> Array:
        """(R,) log density of each trial at another vector, to second order, its nuisances marginalised."""
        step = vector - self.vector
        misfit = self.blocks.misfit - 2.0 * self.blocks.slope @ step
        misfit = misfit + np.einsum("i,rij,j->r", step, self.blocks.matrix, step)
        return np.asarray(-0.5 * np.maximum(misfit, 0.0) - 0.5 * self.blocks.log_size)


def scaled_inverse(matrix: Array) -> Array:
    """Pseudo-inverse of a symmetric matrix (p, p) whose rows may be of very unlike units, such as pascals and shares.

    Without scaling, what is weakly told in large units falls below the cut-off and would seem exactly known.
    """
    size = np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    scale = 1.0 / np.where(size > 1e-140, size, 1.0)
    return np.asarray(np.linalg.pinv(matrix * np.outer(scale, scale), hermitian=True) * np.outer(scale, scale))


@dataclass(frozen=True, eq=False)
class Descent(Generic[Fitted]):
    """Where the steps of a fit ended, and whether by themselves; derivatives there only where it is `finished`."""

    model: Fitted
    at: TrialsEvaluation
    objective: float
    precision: Array
    prior_mean: Array
    converged: bool

    def finished(self) -> TrialsFit[Fitted]:
        """The fit with the derivatives there, and what they say."""
        columns = self.model.columns(self.at)
        return TrialsFit(
            self.model,
            self.at.vector,
            self.at.nuisance,
            self.objective,
            trial_blocks(self.model, columns, self.at),
            self.precision,
            self.prior_mean,
            columns,
            self.converged,
        )


def least_squares(
    model: Model,
    start: Array,
    nuisance: Array,
    *,
    warm: TrialColumns | None = None,
    known: TrialColumns | None = None,
    search: Search = USUAL,
    around: Array | None = None,
) -> TrialsFit[Model]:
    """Fit a model from a start; the parameters are those of `descend`."""
    return descend(model, start, nuisance, warm=warm, known=known, search=search, around=around).finished()


def descend(
    model: Model,
    start: Array,
    nuisance: Array,
    *,
    warm: TrialColumns | None = None,
    known: TrialColumns | None = None,
    search: Search = USUAL,
    around: Array | None = None,
) -> Descent[Model]:
    """Step down from a start.

    Parameters
    ----------
    model
        What is fitted.
    start
        (p,) vector; its priors may lie round it.
    nuisance
        (R, q) start of the trials' nuisances.
    warm
        Derivatives near the start, some of which serve for the first steps.
    known
        Derivatives at the start, where it is within its bounds and they have been worked out.
    search
        How it goes on and when it has converged.
    around
        (p,) vector round which the priors lie, if it is not the start: of a fit that goes on.
    """
    mean, precision = model.prior(start if around is None else around)
    limits = model.trial_bounds
    at = model.evaluated(np.clip(start, *model.bounds), nuisance if limits is None else np.clip(nuisance, *limits))
    value = _objective(model, at, mean, precision)
    damping, columns, converged = search.damping, known, False
    for turn in range(search.most):
        if columns is None:
            columns = model.columns(at, warm if turn < LENT else None)
        tried = model.evaluated(*_moved(model, columns, at, (mean, precision), damping))
        tried_value = _objective(model, tried, mean, precision)
        if tried_value >= value and damping > UNDAMPED and at.nuisance.size:
            tried = model.evaluated(tried.vector, settled(model, tried.vector, at.nuisance))
            tried_value = _objective(model, tried, mean, precision)
        if tried_value < value:
            gain, at, value = value - tried_value, tried, tried_value
            damping, columns = damping * 0.2, None
            converged = gain < max(search.gain, search.share * value)
            if converged:
                break
        else:
            if warm is not None and turn < LENT:
                warm, columns = None, None
            damping = max(damping, 1e-4) * 12.0
            converged = damping > MOST_DAMPING
            if converged:
                break
    return Descent(model, at, value, precision, mean, converged)


def one_step(
    model: Model, at: TrialsEvaluation, columns: TrialColumns, mean: Array, precision: Array
) -> TrialsFit[Model]:
    """The fit of a model that is taken as linear round a point, by its derivatives there; nuisances stay as they are.

    Parameters
    ----------
    model
        What is fitted.
    at, columns
        The point, and the derivatives.
    mean, precision
        (p,) of the priors on the vector.
    """
    blocks = trial_blocks(model, columns, at)
    start = TrialsFit(model, at.vector, at.nuisance, 0.0, blocks, precision, mean, columns)
    vector = start.without(np.zeros(len(blocks.slope), dtype=bool))
    step = vector - at.vector
    moved = np.einsum("rij,j->ri", blocks.matrix, step)
    misfit = blocks.misfit - 2.0 * blocks.slope @ step + moved @ step
    value = 0.5 * float(misfit.sum() + np.sum(precision * (vector - mean) ** 2))
    there = Blocks(blocks.matrix, blocks.slope - moved, misfit, blocks.log_size)
    return TrialsFit(model, vector, at.nuisance, value, there, precision, mean, columns)


def _objective(model: TrialsModel, at: TrialsEvaluation, mean: Array, precision: Array) -> float:
    data = sum(float(r @ r) for r in at.residuals)
    prior = float(np.sum(at.nuisance**2 * model.trial_precision) + np.sum(precision * (at.vector - mean) ** 2))
    total = 0.5 * (data + prior)
    return total if np.isfinite(total) else np.inf


def _moved(
    model: TrialsModel, columns: TrialColumns, at: TrialsEvaluation, prior: tuple[Array, Array], damping: float
) -> tuple[Array, Array]:
    """Vector and nuisances one damped step further, within their bounds."""
    mean, precision = prior
    trials = [_equations(model, columns, at, index) for index in range(len(at.residuals))]
    held = [_held(model, one.pull, at.nuisance[index], index) for index, one in enumerate(trials)]
    limits = model.trial_bounds
    own_edges = None if limits is None else (limits[0] - at.nuisance, limits[1] - at.nuisance)
    edges = (model.bounds[0] - at.vector, model.bounds[1] - at.vector)
    step, moves = joint_step(trials, (precision, -precision * (at.vector - mean)), damping, edges, own_edges, held)
    own = at.nuisance + moves if limits is None else stepped(at.nuisance, moves, limits)
    return stepped(at.vector, step, model.bounds), own


def _equations(model: TrialsModel, columns: TrialColumns, at: TrialsEvaluation, index: int) -> TrialEquations:
    """A trial's normal equations."""
    weight = model.trial_precision
    return trial_equations(
        columns.vector[index], columns.nuisance[index], at.residuals[index], at.nuisance[index], weight
    )


def _held(model: TrialsModel, pull: Array, own: Array, index: int) -> NDArray[np.bool_]:
    """Which nuisances (q,) of a trial stand at a bound that they are pulled beyond."""
    limits = model.trial_bounds
    if limits is None:
        return np.zeros(own.size, dtype=bool)
    return np.asarray(((own <= limits[0][index]) & (pull <= 0.0)) | ((own >= limits[1][index]) & (pull >= 0.0)))


def trial_blocks(model: TrialsModel, columns: TrialColumns, at: TrialsEvaluation) -> Blocks:
    """What each trial says, as if its nuisances began at zero; those at a bound stay there."""
    matrices, slopes, misfits, sizes = [], [], [], []
    weight = model.trial_precision
    for index, residual in enumerate(at.residuals):
        own, trial = at.nuisance[index], _equations(model, columns, at, index)
        held = _held(model, trial.pull, own, index)
        one = trial.eliminated(np.zeros(held.size), held)
        matrices.append(one.matrix)
        slopes.append(one.slope)
        misfits.append(float(residual @ residual + own @ (weight * own) - trial.pull @ one.solved[:, -1]))
        sizes.append(float(np.linalg.slogdet(trial.inner)[1] - np.log(weight[weight > 0.0]).sum()))
    return Blocks(np.array(matrices), np.array(slopes), np.array(misfits), np.array(sizes))


def settled(model: TrialsModel, vector: Array, nuisance: Array, search: Search = SETTLED) -> Array:
    """(R, q) nuisances of the trials at a vector that stays: each trial by itself, damped until it has converged."""
    weight, damping = model.trial_precision, np.full(len(nuisance), search.damping)
    low, high = model.trial_bounds or (np.full_like(nuisance, -np.inf), np.full_like(nuisance, np.inf))
    at = model.evaluated(vector, np.clip(nuisance, low, high))
    value = _trial_objectives(at, weight)
    going = np.ones(len(nuisance), dtype=bool)
    for _ in range(search.most):
        columns, tried = model.nuisance_columns(at), at.nuisance.copy()
        for index in np.flatnonzero(going):
            n = columns[index]
            inner, pull = n.T @ n + np.diag(weight), n.T @ at.residuals[index] - weight * tried[index]
            bounds = (low[index], high[index])
            edges = (bounds[0] - tried[index], bounds[1] - tried[index])
            tried[index] = stepped(tried[index], bounded_step(inner, pull, edges, damping[index]), bounds)
        other = model.evaluated(vector, tried)
        new = _trial_objectives(other, weight)
        better = going & (new < value)
        gain = value - new
        at, value = _mixed(at, other, better), np.where(better, new, value)
        damping = np.where(better, 0.2 * damping, 12.0 * np.maximum(damping, 1e-4))
        going &= np.where(better, gain >= np.maximum(search.gain, search.share * value), damping <= MOST_DAMPING)
        if not going.any():
            break
    return at.nuisance


def _trial_objectives(at: TrialsEvaluation, weight: Array) -> Array:
    """(R,) half the sum of squares of each trial with its priors."""
    data = np.array([float(r @ r) for r in at.residuals])
    total = 0.5 * (data + np.sum(at.nuisance**2 * weight, axis=1))
    return np.asarray(np.where(np.isfinite(total), total, np.inf))


def _mixed(one: TrialsEvaluation, other: TrialsEvaluation, which: NDArray[np.bool_]) -> TrialsEvaluation:
    """An evaluation with some trials (mask (R,)) from another."""
    nuisance = np.where(which[:, None], other.nuisance, one.nuisance)
    signals = [b if pick else a for a, b, pick in zip(one.signals, other.signals, which, strict=bool(one.signals))]
    residuals = [b if pick else a for a, b, pick in zip(one.residuals, other.residuals, which, strict=True)]
    return TrialsEvaluation(one.vector, nuisance, signals, residuals)


def fit_record(record: RecordModel, start: Array, search: Search = EXACT) -> TrialsFit[RecordModel]:
    """Fit one record from a start (p,)."""
    return least_squares(record, start, np.zeros((1, 0)), search=search)
