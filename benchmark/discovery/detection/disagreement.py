"""Is there a disagreement: the base's residuals tested in cells, refitted once on the clean ones, and row by row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm
from scipy.stats import t as t_distribution

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import EffectModel, Fit, White, fit
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.cells import (
    CellTable,
    FlipTest,
    cell_means,
    cells_of,
    flip_test,
    misses_nothing,
    projected_residuals,
    share_of_flips,
    sign_patterns,
    too_small,
)
from benchmark.discovery.discovery_result import Array

SAME = 1e-12
"""Of the sum of all sizes, by which the same products in another order may differ."""


@dataclass(frozen=True, eq=False)
class Detection:
    """Cells and their test, on the fit that used the clean cells.

    `p` is of anything before that refit, matched directions and the base's strain included, `p_cells` that of the cells
    alone by what they exceed the smallest size by, as are `table` and `test`: what is smaller is an effect or nothing.
    """

    table: CellTable
    test: FlipTest
    p: float
    p_cells: float
    trend: Array


def detect(fitted: Fit, settings: Settings, matched: Array | None = None) -> Detection:
    """Test the residuals of a fit; `matched` (M, R) are further numbers a trial that share in the test."""
    plain = _table(fitted)
    large = _large(fitted, plain)
    of_any_size, test = _tested(plain, settings), _tested(large, settings)
    p_cells, flagged = test.p_any, of_any_size.p < settings.level
    if flagged.any() and flagged.mean() < criteria.MOST_FLAGGED:
        large = _large(fitted, _table(_refitted(fitted, plain, flagged), full=fitted))
        test = _tested(large, settings)
    anything = of_any_size if matched is None else _tested(replace(plain, matched=matched), settings)
    p = combined(anything.p_any, strained(fitted))
    return Detection(large, test, p=p, p_cells=p_cells, trend=_trend(fitted, plain))


def combined(*values: float) -> float:
    """Least p of several tests that share the level as `criteria.LEVEL_SHARES` say."""
    return float(min(1.0, *(value / share for value, share in zip(values, criteria.LEVEL_SHARES, strict=False))))


def strained(fitted: Fit, form: float = 0.0) -> float:
    """Family-wise p that the base's shape lies as far off as the data bend it, by the normal priors of its nuisances.

    What a base can follow by bending leaves no residual, so that no cell shows it. Up to a cost of `form` in log
    density it bends to what the forms of effects miss, and says nothing of the set-up.
    """
    free = [k for k, name in enumerate(fitted.model.problem.shapes) if name != "modulus"]
    z = np.abs(fitted.vector[free] - fitted.prior_mean[free]) * np.sqrt(fitted.precision[free])
    if 0.5 * float(z @ z) < form:
        return 1.0
    return float(min(1.0, len(free) * 2.0 * norm.sf(z.max())))


def nothing_amiss(fitted: Fit) -> bool:
    """Whether a model misses nothing, and bends no further for that than its set-up as told allows."""
    return misses_nothing(fitted) and strained(fitted) >= criteria.STRAINED


def _table(fitted: Fit, full: Fit | None = None) -> CellTable:
    problem = (full or fitted).model.problem
    return cell_means(problem, projected_residuals(fitted), cells_of(problem))


def _large(fitted: Fit, table: CellTable) -> CellTable:
    """The table of which only what is no longer small counts."""
    return replace(table, least=too_small(fitted.model.problem)[[cell.signal for cell in table.cells]])


def _tested(table: CellTable, settings: Settings) -> FlipTest:
    return flip_test(table, settings.flips, settings.seed)


def _refitted(fitted: Fit, table: CellTable, flagged: NDArray[np.bool_]) -> Fit:
    """The model fitted on the rows of cells that are not flagged."""
    problem = fitted.model.problem
    masks = [np.ones(c.signals.shape[1:], dtype=bool) for c in problem.study.conditions]
    for cell, bad in zip(table.cells, flagged, strict=True):
        if bad:
            for condition, rows in cell.rows.items():
                masks[condition][rows, cell.signal] = False
    clean = replace(problem, mask=tuple(masks))
    model = EffectModel(clean, fitted.model.effects)
    return fit(model, fitted.vector, fitted.nuisance, most=4)


def _trend(fitted: Fit, table: CellTable) -> Array:
    """(K,) slope of each cell's mean over the trial number, within conditions: Student's t as a normal deviate."""
    problem = fitted.model.problem
    numbers = np.array([trial.number for trial in problem.trials], dtype=float)
    groups = np.array([trial.condition for trial in problem.trials])
    out = np.zeros(len(table.cells))
    for k, row in enumerate(table.means):
        known = np.isfinite(row)
        freedom = int(known.sum()) - np.unique(groups[known]).size - 1
        if freedom < 2:
            continue
        x, y = _centred(numbers[known], groups[known]), _centred(row[known], groups[known])
        if not x.any():
            continue
        slope = float(x @ y) / float(x @ x)
        rest = y - slope * x
        error = np.sqrt(float(rest @ rest) / freedom / float(x @ x))
        out[k] = np.copysign(norm.isf(t_distribution.sf(abs(slope) / max(error, 1e-300), freedom)), slope)
    return out


def _centred(values: Array, groups: NDArray[np.int64]) -> Array:
    """Values (n,) less the mean of their group, so that conditions measured in blocks give no slope."""
    out = values.copy()
    for group in np.unique(groups):
        out[groups == group] -= values[groups == group].mean()
    return out


def smallest_visible(fitted: Fit, detection: Detection) -> dict[str, float]:
    """For each channel the smallest mean residual that would have been flagged, N or m."""
    channels = fitted.model.problem.study.channels
    out: dict[str, float] = {}
    least = detection.table.least
    for k, cell in enumerate(detection.table.cells):
        size = float(detection.test.critical * detection.test.error[k]) + (0.0 if least is None else float(least[k]))
        channel = channels[cell.signal]
        out[channel] = min(out.get(channel, np.inf), size)
    return out


def exchangeable(detection: Detection) -> tuple[str, ...]:
    """A remark where the trials cannot be exchanged, which the sign flips rest on."""
    if detection.trend.size and abs(detection.trend).max() > criteria.TREND:
        return (
            "residuals change with the trial number: the trials are not exchangeable (softening, set or drift from "
            "trial to trial)",
        )
    return ()


def shared_misfit(fitted: Fit) -> float:
    """Squared norm of the whitened mean residual, in standard errors, above its expectation from replicates.

    Each condition gives R |mean|^2 less the sum of its variances over trials; a condition without replicates gives its
    rows' number in the place of the variances. Noise counts as no less than what is too small to matter.
    """
    return float(_in_common(fitted, _rows(fitted)).sum())


def shared_by_chance(fitted: Fit, settings: Settings) -> float:
    """P that trials share as much misfit by chance: what they share after flips of whole trials' signs, as for cells.

    Cells average over phases and halves; this sees what changes its sign within one, such as a ringing or a dent.
    """
    products = _in_common(fitted, _rows(fitted))
    return float(_beyond_flips(products[None], settings)[0])


def shared_by(fitted: Fit, picks: Sequence[Sequence[NDArray[np.bool_]]], settings: Settings) -> tuple[Array, Array]:
    """(K,) misfit that trials share in each of some picks of rows ((n, C) of each trial), and its family-wise p."""
    rows = _rows(fitted)
    products = np.array([_in_common(fitted, [r * p for r, p in zip(rows, pick, strict=True)]) for pick in picks])
    return products.sum(axis=(1, 2)), _beyond_flips(products, settings)


def _rows(fitted: Fit) -> list[Array]:
    """White residuals (n, C) of each trial."""
    problem = fitted.model.problem
    residuals = White(problem).residuals(fitted.model.signals(fitted.vector, fitted.nuisance))
    ratio = np.minimum(problem.noise.scale / too_small(problem), 1.0)
    return [each.reshape(-1, ratio.shape[1]) * ratio[i] for i, each in enumerate(residuals)]


def _in_common(fitted: Fit, rows: Sequence[Array]) -> Array:
    """(R, R) what two trials have in common: products of their rows, over the mates of each in its condition."""
    groups = np.array([trial.condition for trial in fitted.model.problem.trials])
    out = np.zeros((groups.size, groups.size))
    for number in np.unique(groups):
        mine = np.flatnonzero(groups == number)
        flat = np.array([rows[i].ravel() for i in mine.tolist()])
        shared = flat @ flat.T
        if mine.size > 1:
            np.fill_diagonal(shared, 0.0)
            shared /= mine.size - 1
        else:
            shared -= np.count_nonzero(flat)
        out[np.ix_(mine, mine)] = shared
    return out


def _beyond_flips(products: Array, settings: Settings) -> Array:
    """(K,) family-wise p of the sums of products (K, R, R), each in units of its scatter over the flips."""
    count = products.shape[1]
    signs = sign_patterns(count, settings.flips, settings.seed)
    flipped = np.column_stack([np.sum(signs @ each * signs, axis=1) for each in products])
    unit = np.maximum(flipped.std(axis=0), 1e-300)
    shown = (products.sum(axis=(1, 2)) - SAME * np.abs(products).sum(axis=(1, 2))) / unit
    return share_of_flips((flipped / unit).max(axis=1)[:, None] >= shown[None], count)
