"""Residuals in cells: one number a trial and cell, and the test of all cells at once by sign flips of whole trials."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmark.discovery.fit import Fit, White
from benchmark.discovery.model import nuisance_precision
from benchmark.discovery.problem import Problem
from benchmark.discovery.result import Array

ALL_FLIPS = 12
"""Up to so many trials all sign patterns are taken."""
STEADY = 4.0
"""Trials that the pooled variance of a signal's cells counts as."""
LEAST_ROWS = 2


@dataclass(frozen=True, eq=False)
class Cell:
    """Where a mean is taken: of one signal, over `rows` ((n,) bool) of each condition by its number."""

    phase: int
    cycle: int
    part: int
    signal: int
    rows: Mapping[int, np.ndarray]


@dataclass(frozen=True, eq=False)
class CellTable:
    """Means of cells: `means` (K, R), NaN for trials of other conditions; `cells` (K,)."""

    cells: tuple[Cell, ...]
    means: Array


@dataclass(frozen=True, eq=False)
class FlipTest:
    """Result: t (K,) of each cell, family-wise p (K,) and the |t| (K,) that would have reached the level, and p."""

    t: Array
    p: Array
    critical: float
    error: Array
    p_any: float


def cells_of(problem: Problem) -> tuple[Cell, ...]:
    """Cells of phase, cycle (third and later ones together), half and signal, over all conditions that have them."""
    found: dict[tuple[int, int, int, int], dict[int, np.ndarray]] = {}
    for number, condition in enumerate(problem.study.conditions):
        cycle = np.minimum(condition.cycle, 3)
        keys = sorted(set(zip(condition.phase.tolist(), cycle.tolist(), condition.part.tolist(), strict=True)))
        for phase, turn, part in keys:
            rows = (condition.phase == phase) & (cycle == turn) & (condition.part == part)
            if rows.sum() < LEAST_ROWS:
                continue
            for signal in range(condition.signals.shape[2]):
                if np.isfinite(condition.signals[:, rows, signal]).all():
                    found.setdefault((phase, turn, part, signal), {})[number] = rows
    return tuple(Cell(*key, rows) for key, rows in sorted(found.items(), key=lambda pair: pair[0]))


def projected_residuals(fitted: Fit) -> list[Array]:
    """Residuals (n, C) of each trial less their part along the tangent of the base's and the trial's nuisances.

    Priors of these hold here as in the fit, so that the tightly held ones take away little.
    """
    model, problem = fitted.model, fitted.model.problem
    signals = model.signals(fitted.vector, fitted.nuisance)
    plain = _tangents(fitted)
    white_residuals = White(problem)
    out = []
    for i, trial in enumerate(problem.trials):
        j, n = fitted.columns.vector[i], fitted.columns.nuisance[i]
        white = np.hstack([j[:, : model.shape_count], n])
        weight = np.concatenate([fitted.precision[: model.shape_count], nuisance_precision(problem)])
        residual = trial.signals - signals[i]
        flat = white_residuals.flat(i, residual)
        inner = white.T @ white + np.diag(weight)
        amount = np.linalg.solve(inner, white.T @ flat)
        out.append(residual - np.tensordot(plain[i], amount, axes=([-1], [0])))
    return out


def _tangents(fitted: Fit) -> list[Array]:
    """(n, C, s + q) derivatives of each trial's signals by the base's nuisances and its own, in raw units."""
    model = fitted.model
    signals = model.signals(fitted.vector, fitted.nuisance)
    out: list[list[Array]] = [[] for _ in signals]
    for k in range(model.shape_count):
        moved = fitted.vector.copy()
        moved[k] += 1e-3
        for i, one in enumerate(model.signals(moved, fitted.nuisance)):
            out[i].append((one - signals[i]) / 1e-3)
    for k in range(fitted.nuisance.shape[1]):
        step = (0.01, 1e-3, max(0.2 * model.problem.study.raw_interval, 1e-3))[k] if k < 3 else 1e-6
        state = fitted.nuisance.copy()
        state[:, k] += step
        for i, one in enumerate(model.signals(fitted.vector, state)):
            out[i].append((one - signals[i]) / step)
    return [np.stack(columns, axis=-1) for columns in out]


def cell_means(problem: Problem, residuals: list[Array], cells: tuple[Cell, ...]) -> CellTable:
    """Means of residuals (n, C) over the rows of each cell."""
    means = np.full((len(cells), len(problem.trials)), np.nan)
    for k, cell in enumerate(cells):
        for i, trial in enumerate(problem.trials):
            rows = cell.rows.get(trial.condition)
            if rows is not None:
                weight = trial.count[rows, cell.signal]
                means[k, i] = np.sum(residuals[i][rows, cell.signal] * weight) / max(weight.sum(), 1e-12)
    return CellTable(cells, means)


def flip_test(table: CellTable, flips: int, seed: int) -> FlipTest:
    """Family-wise p of each cell's mean over trials.

    The statistic is t with a variance that is shrunk to the median of the signal's cells; its largest value over all
    cells is compared with those after flipping the signs of whole trials, which under no disagreement changes nothing.
    """
    means = table.means
    signals = np.array([(cell.signal, min(cell.rows), len(cell.rows)) for cell in table.cells])
    signs = _signs(means.shape[1], flips, seed)
    t, error = (column[0] for column in _statistics(means, signals, np.ones((1, means.shape[1]))))
    largest = np.abs(_statistics(means, signals, signs)[0]).max(axis=1)
    p = (1.0 + (largest[:, None] >= np.abs(t)[None] - 1e-9).sum(axis=0)) / (1.0 + len(signs))
    if means.shape[1] <= ALL_FLIPS:
        p = (largest[:, None] >= np.abs(t)[None] - 1e-9).mean(axis=0)
    return FlipTest(t, p, float(np.quantile(largest, 0.95, method="higher")), error, float(p.min()))


def _signs(trials: int, flips: int, seed: int) -> Array:
    if trials <= ALL_FLIPS:
        half = np.array(list(itertools.product((1.0, -1.0), repeat=trials - 1)))
        return np.hstack([np.ones((len(half), 1)), half])
    return np.asarray(np.random.default_rng(seed).choice((1.0, -1.0), size=(flips, trials)))


def _statistics(means: Array, groups: Array, signs: Array) -> tuple[Array, Array]:
    """(S, K) t and standard errors after each of S flips (S, R)."""
    count = np.isfinite(means).sum(axis=1)
    known = np.nan_to_num(means)
    mean = signs @ known.T / count
    spread = ((known**2).sum(axis=1) - count * mean**2) / np.maximum(count - 1, 1)
    spread = np.maximum(spread, 1e-12 * (known**2).sum(axis=1) / count)
    pooled = np.empty_like(spread)
    for group in np.unique(groups, axis=0):
        mine = (groups == group).all(axis=1)
        pooled[:, mine] = np.median(spread[:, mine], axis=1, keepdims=True)
    shrunk = (STEADY * pooled + (count - 1) * spread) / (STEADY + count - 1)
    error = np.sqrt(shrunk / count)
    return mean / np.maximum(error, 1e-300), error
