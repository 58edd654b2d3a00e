"""Fitting a model to trials: damped Gauss-Newton, each trial's nuisances eliminated in closed form.

The trials meet in the model's vector alone, so the normal matrix is an arrow; what a trial says of the vector, after
its own nuisances, is kept as its block. The blocks also give the fit without a trial, to first order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery.discovery_result import Array
from benchmark.discovery.model import Model, nuisance_count, nuisance_precision
from benchmark.discovery.problem import OFFSETS, OWN, Problem

DAMPING = 1e-3
MOST = 12
CLOSE = 0.03
SHARE = 3e-5
"""A fit has converged where a step lowers half the sum of squares by less than CLOSE, or this share of it."""
LENT = 3
"""Steps for which the base's derivatives of a start serve."""


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
class Fit:
    """A model fitted.

    Attributes
    ----------
    model : Model
    vector : (p,)
    nuisance : (R, q)
    objective : float
        Half the sum of squares with all priors.
    blocks : Blocks
        At the solution.
    precision : (p,)
        Of the priors on the vector.
    prior_mean : (p,)
    columns : Columns
        Derivatives at the solution.
    """

    model: Model
    vector: Array
    nuisance: Array
    objective: float
    blocks: Blocks
    precision: Array
    prior_mean: Array
    columns: Columns

    @property
    def covariance(self) -> Array:
        """(p, p) of the vector."""
        total = self.blocks.matrix.sum(axis=0) + np.diag(self.precision)
        return np.asarray(np.linalg.pinv(total, hermitian=True))

    def without(self, trials: NDArray[np.bool_]) -> Array:
        """(p,) of the fit without some trials (mask (R,)), to first order, within the bounds."""
        matrix = self.blocks.matrix[~trials].sum(axis=0) + np.diag(self.precision)
        slope = self.blocks.slope[~trials].sum(axis=0) - self.precision * (self.vector - self.prior_mean)
        step = _bounded(matrix, slope, self.vector, 1e-9, self.model.bounds)
        return np.clip(self.vector + step, *self.model.bounds)

    def log_density(self, vector: Array) -> Array:
        """(R,) log density of each trial at another vector, to second order, its nuisances marginalised."""
        step = vector - self.vector
        misfit = self.blocks.misfit - 2.0 * self.blocks.slope @ step
        misfit = misfit + np.einsum("i,rij,j->r", step, self.blocks.matrix, step)
        density = -0.5 * np.maximum(misfit, 0.0) - 0.5 * self.blocks.log_size
        return np.asarray(density)


@dataclass(frozen=True, eq=False)
class Columns:
    """White derivatives of each trial: by the vector (N, p) and by the trial's nuisances (N, q)."""

    vector: list[Array]
    nuisance: list[Array]


@dataclass(frozen=True, eq=False)
class White:
    """Residual vectors of a problem, whitened and flattened: one array a trial."""

    problem: Problem

    def __post_init__(self) -> None:
        object.__setattr__(self, "_use", [self.problem.whiteners(i) for i in range(len(self.problem.trials))])

    def flat(self, index: int, rows: Array) -> Array:
        """Rows (n, C) of a trial whitened, masked and flattened to (N,)."""
        use = self._use[index]  # type: ignore[attr-defined]
        white = np.column_stack([use[signal](rows[:, signal]) for signal in range(rows.shape[1])])
        mask = self.problem.mask
        if mask is not None:
            white = white * mask[self.problem.trials[index].condition]
        return np.asarray(white.ravel())

    def residuals(self, signals: list[Array]) -> list[Array]:
        """White residuals, measured minus simulated."""
        return [self.flat(i, trial.signals - signals[i]) for i, trial in enumerate(self.problem.trials)]


def fit(
    model: Model, start: Array, nuisance: Array | None = None, warm: Columns | None = None, most: int = MOST
) -> Fit:
    """Fit a model from a start.

    Parameters
    ----------
    model
        What is fitted.
    start
        (p,) vector; logarithmic parameters have their priors round it.
    nuisance
        (R, q) start of the trials' nuisances; zeros by default.
    warm
        Derivatives of the base near the start, whose columns serve for the first steps.
    most
        Steps at most.
    """
    problem = model.problem
    white = White(problem)
    state = np.zeros((len(problem.trials), nuisance_count(problem))) if nuisance is None else nuisance.copy()
    mean, precision = model.prior(start)
    vector = np.clip(start, *model.bounds)
    signals = model.signals(vector, state)
    residuals = white.residuals(signals)
    value = _objective(problem, residuals, state, vector, mean, precision)
    damping, columns = DAMPING, None
    for turn in range(most):
        if columns is None:
            columns = _columns(model, white, vector, state, signals, warm if turn < LENT else None)
        step, moves = _step(problem, columns, residuals, state, vector, (mean, precision), damping, model.bounds)
        tried, tried_state = np.clip(vector + step, *model.bounds), state + moves
        tried_signals = model.signals(tried, tried_state)
        tried_residuals = white.residuals(tried_signals)
        tried_value = _objective(problem, tried_residuals, tried_state, tried, mean, precision)
        if tried_value < value:
            gain = value - tried_value
            vector, state, signals, residuals, value = tried, tried_state, tried_signals, tried_residuals, tried_value
            damping, columns = damping * 0.2, None
            if gain < max(CLOSE, SHARE * value):
                break
        else:
            if warm is not None and turn < LENT:
                warm, columns = None, None
            damping = max(damping, 1e-4) * 12.0
            if damping > 1e5:
                break
    columns = _columns(model, white, vector, state, signals, None)
    blocks = _blocks(problem, columns, residuals, state)
    return Fit(model, vector, state, value, blocks, precision, mean, columns)


def _objective(
    problem: Problem, residuals: list[Array], state: Array, vector: Array, mean: Array, precision: Array
) -> float:
    data = sum(float(r @ r) for r in residuals)
    prior = float(np.sum(state**2 * nuisance_precision(problem)) + np.sum(precision * (vector - mean) ** 2))
    total = 0.5 * (data + prior)
    return total if np.isfinite(total) else np.inf


def _columns(
    model: Model, white: White, vector: Array, state: Array, signals: list[Array], warm: Columns | None
) -> Columns:
    """Derivatives by differences; `warm` lends those by the base's nuisances and the trials'."""
    count = len(signals)
    changes: list[list[Array]] = []
    first = 0
    if warm is not None:
        first = model.shape_count
    for k in range(first, model.size):
        step = _difference(model, vector, k)
        moved = vector.copy()
        moved[k] += step
        changed = model.signals(moved, state)
        changes.append([white.flat(i, (changed[i] - signals[i]) / step) for i in range(count)])
    own = [np.column_stack([c[i] for c in changes]) if changes else np.zeros((0, 0)) for i in range(count)]
    if warm is not None:
        shapes = [columns[:, : model.shape_count] for columns in warm.vector]
        vectors = [np.hstack([s, o]) if o.size else s for s, o in zip(shapes, own, strict=True)]
        return Columns(vectors, warm.nuisance)
    return Columns(own, _nuisance_columns(model, white, vector, state, signals))


def _difference(model: Model, vector: Array, k: int) -> float:
    if k < model.shape_count:
        return 1e-3
    _, p = model.parameters[k - model.shape_count]
    size = 0.02 if p.logarithmic else max(0.02 * abs(vector[k]), 1e-5 * (p.high - p.low))
    return size if vector[k] + size <= model.bounds[1][k] else -size


def _nuisance_columns(model: Model, white: White, vector: Array, state: Array, signals: list[Array]) -> list[Array]:
    problem = model.problem
    layout = problem.study.layout
    deepest = max(condition.around.peak_depth for condition in problem.study.conditions)
    steps = {0: 0.01, 2: max(0.2 * problem.study.raw_interval, 1e-3), 3: 1e-3 * deepest}
    moved = {}
    for k, step in steps.items():
        other = state.copy()
        other[:, k] += step
        moved[k] = model.signals(vector, other)
    out = []
    for i, base in enumerate(signals):
        columns = np.zeros((*base.shape, state.shape[1]))
        columns[:, 0, 1] = 1.0
        for k, step in steps.items():
            columns[..., k] = (moved[k][i] - base) / step
        if layout is not None:
            for k, name in enumerate(OFFSETS, start=len(OWN)):
                columns[:, 1 + layout.names.index(name), k] = 1.0
        out.append(np.column_stack([white.flat(i, columns[..., k]) for k in range(state.shape[1])]))
    return out


def _step(
    problem: Problem,
    columns: Columns,
    residuals: list[Array],
    state: Array,
    vector: Array,
    prior: tuple[Array, Array],
    damping: float,
    bounds: tuple[Array, Array],
) -> tuple[Array, Array]:
    mean, precision = prior
    matrix, slope = np.diag(precision).astype(float), -precision * (vector - mean)
    weight = nuisance_precision(problem)
    parts = []
    for i, residual in enumerate(residuals):
        j, n = columns.vector[i], columns.nuisance[i]
        inner = n.T @ n + np.diag(weight)
        side, pull = n.T @ j, n.T @ residual - weight * state[i]
        solved = np.linalg.solve(inner, np.column_stack([side, pull]))
        matrix += j.T @ j - side.T @ solved[:, :-1]
        slope += j.T @ residual - side.T @ solved[:, -1]
        parts.append(solved)
    step = _bounded(matrix, slope, vector, damping, bounds)
    moves = np.array([solved[:, -1] - solved[:, :-1] @ step for solved in parts])
    return step, moves


def _bounded(matrix: Array, slope: Array, vector: Array, damping: float, bounds: tuple[Array, Array]) -> Array:
    """Damped step within the bounds: what would leave them stops at their edge, and the others make up for it."""
    low, high = bounds[0] - vector, bounds[1] - vector
    damped = matrix + np.diag(damping * np.maximum(np.diag(matrix), 1e-12))
    free = np.ones(vector.size, dtype=bool)
    step = np.zeros(vector.size)
    for _ in range(vector.size):
        if not free.any():
            return step
        pull = slope[free] - matrix[np.ix_(free, ~free)] @ step[~free]
        step[free] = np.linalg.solve(damped[np.ix_(free, free)], pull)
        out = free & ((step < low) | (step > high))
        if not out.any():
            return step
        step[out] = np.clip(step, low, high)[out]
        free &= ~out
    return step


def _blocks(problem: Problem, columns: Columns, residuals: list[Array], state: Array) -> Blocks:
    weight = nuisance_precision(problem)
    matrices, slopes, misfits, sizes = [], [], [], []
    for i, residual in enumerate(residuals):
        j, n = columns.vector[i], columns.nuisance[i]
        free = residual + n @ state[i]
        inner = n.T @ n + np.diag(weight)
        side, pull = n.T @ j, n.T @ free
        solved = np.linalg.solve(inner, np.column_stack([side, pull]))
        matrices.append(j.T @ j - side.T @ solved[:, :-1])
        slopes.append(j.T @ free - side.T @ solved[:, -1])
        misfits.append(float(free @ free - pull @ solved[:, -1]))
        sizes.append(float(np.linalg.slogdet(inner)[1] - np.log(weight).sum()))
    return Blocks(np.array(matrices), np.array(slopes), np.array(misfits), np.array(sizes))


def settled(model: Model, vector: Array, nuisance: Array, turns: int = 2) -> Array:
    """(R, q) nuisances of the trials at a vector that stays."""
    problem = model.problem
    if problem.mask is not None:
        from dataclasses import replace

        model = Model(replace(problem, mask=None), model.effects)
        problem = model.problem
    white, state = White(problem), nuisance.copy()
    weight = nuisance_precision(problem)
    for _ in range(turns):
        signals = model.signals(vector, state)
        residuals = white.residuals(signals)
        columns = _nuisance_columns(model, white, vector, state, signals)
        for i, residual in enumerate(residuals):
            n = columns[i]
            state[i] += np.linalg.solve(n.T @ n + np.diag(weight), n.T @ residual - weight * state[i])
    return state
