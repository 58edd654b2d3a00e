"""Residuals in cells: one number a trial and cell, how large they are, and the test of all at once by sign flips."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import Fit, White, nuisance_precision
from benchmark.discovery.base.trials_problem import TrialsProblem
from benchmark.discovery.criteria import Settings
from benchmark.discovery.discovery_result import Array, ChannelSize


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
    """Means of cells.

    Attributes
    ----------
    cells : (K,)
    means : (K, R)
        NaN for trials of other conditions.
    groups : (R,) or None
        Condition of each trial; None: all in one.
    matched : (M, R) or None
        Further numbers a trial that share in the test, from one side: the residual along each effect's direction.
    least : (K,) or None
        Size up to which the mean of a cell is no disagreement; None: 0.
    """

    cells: tuple[Cell, ...]
    means: Array
    groups: np.ndarray | None = None
    matched: Array | None = None
    least: Array | None = None


@dataclass(frozen=True, eq=False)
class FlipTest:
    """Result: t, family-wise p and standard error (K,) of each cell, the |t| that reaches 5 %, and p of anything."""

    t: Array
    p: Array
    critical: float
    error: Array
    p_any: float


def cells_of(problem: TrialsProblem) -> tuple[Cell, ...]:
    """Cells of phase, cycle (third and later ones together), half and signal, over all conditions that have them."""
    found: dict[tuple[int, int, int, int], dict[int, np.ndarray]] = {}
    for number, condition in enumerate(problem.study.conditions):
        cycle = np.minimum(condition.cycle, criteria.MOST_CYCLE)
        keys = sorted(set(zip(condition.phase.tolist(), cycle.tolist(), condition.part.tolist(), strict=True)))
        for phase, turn, part in keys:
            rows = (condition.phase == phase) & (cycle == turn) & (condition.part == part)
            if rows.sum() < criteria.LEAST_ROWS:
                continue
            for signal in range(condition.signals.shape[2]):
                if (condition.count[:, rows, signal].sum(axis=1) > 0.0).all():
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


def cell_means(problem: TrialsProblem, residuals: list[Array], cells: tuple[Cell, ...]) -> CellTable:
    """Means of residuals (n, C) over the rows of each cell."""
    means = np.full((len(cells), len(problem.trials)), np.nan)
    for k, cell in enumerate(cells):
        for i, trial in enumerate(problem.trials):
            rows = cell.rows.get(trial.condition)
            if rows is not None:
                weight = trial.count[rows, cell.signal]
                means[k, i] = np.sum(residuals[i][rows, cell.signal] * weight) / max(weight.sum(), 1e-12)
    return CellTable(cells, means, np.array([trial.condition for trial in problem.trials]))


def flip_test(table: CellTable, flips: int, seed: int) -> FlipTest:
    """Family-wise p of each cell's mean over trials.

    The statistic is the root of the sum over conditions of squared t, signed by the sum of the means, with the variance
    within conditions, shrunk to the median of like cells. Its largest value over all cells (and matched numbers) is
    compared with those after flipping the signs of whole trials, which under no disagreement changes nothing. What a
    cell must exceed is taken from its own mean, not from the flipped ones, so that the level holds.
    """
    means = table.means if table.matched is None else np.vstack([table.means, table.matched])
    kinds = [(cell.signal, min(cell.rows), len(cell.rows)) for cell in table.cells]
    kinds += [(-1, 0, 0)] * (len(means) - len(kinds))
    groups = np.zeros(means.shape[1], dtype=int) if table.groups is None else table.groups
    sided = np.arange(len(means)) >= len(table.cells)
    size = len(table.cells)
    least = np.zeros(len(means))
    if table.least is not None:
        least[:size] = table.least
    t, error, p, flipped = _flipped(means, np.array(kinds), sided, groups, (flips, seed), least)
    critical = float(np.quantile(_largest(flipped, sided), 0.95, method="higher"))
    return FlipTest(t[:size], p[:size], critical, error[:size], float(p.min()))


def reachable(groups: np.ndarray, settings: Settings) -> bool:
    """Whether the test of trials (R,), by their condition, can reach its level: enough of them, and some repeated."""
    counts = np.unique(groups, return_counts=True)[1]
    if groups.size < criteria.ENOUGH_TRIALS or counts.max() < 2:
        return False
    return bool(least_p(groups, settings) / criteria.LEVEL_SHARES[0] < settings.level)


def least_p(groups: np.ndarray, settings: Settings) -> float:
    """The smallest p that any data could have.

    Flipping all trials of a condition leaves the size of a statistic as it is, so that of the 2^R patterns 2^(G - 1)
    are as large as the data's own, from the side that counts.
    """
    if groups.size > criteria.ALL_FLIPS:
        return 1.0 / (1.0 + settings.flips)
    return float(2.0 ** (len(_members(groups)) - 1 - groups.size))


def one_sided(rows: Array, groups: np.ndarray, flips: int, seed: int) -> Array:
    """(K,) family-wise p that numbers (K, R), one a trial, lie above zero in the mean."""
    kinds = np.tile([-1, 0, 0], (len(rows), 1))
    return _flipped(rows, kinds, np.ones(len(rows), dtype=bool), groups, (flips, seed), np.zeros(len(rows)))[2]


def _flipped(
    means: Array, kinds: Array, sided: np.ndarray, groups: np.ndarray, draw: tuple[int, int], least: Array
) -> tuple[Array, Array, Array, Array]:
    """Of means (K, R): t beyond `least`, standard error, family-wise p, (K,) each, and statistics (S, K) of flips."""
    count = means.shape[1]
    weights, signs = _members(groups), sign_patterns(count, *draw)
    t, error = (column[0] for column in _statistics(means, kinds, np.ones((1, count)), weights))
    t = np.sign(t) * np.maximum(np.abs(t) - least / np.maximum(error, 1e-300), 0.0)
    flipped = _statistics(means, kinds, signs, weights)[0]
    shown = np.where(sided, t, np.abs(t))
    above = _largest(flipped, sided)[:, None] >= shown[None] - 1e-9
    return t, error, share_of_flips(above, count), flipped


def share_of_flips(above: np.ndarray, trials: int) -> Array:
    """P from which flips (S, ...) reach what the data show: of all there are, or of those drawn and the data's own."""
    if trials <= criteria.ALL_FLIPS:
        return np.asarray(above.mean(axis=0))
    return np.asarray((1.0 + above.sum(axis=0)) / (1.0 + len(above)))


def _largest(flipped: Array, sided: np.ndarray) -> Array:
    """(S,) largest statistic of each flip; `sided` ones count from one side."""
    return np.asarray(np.where(sided, flipped, np.abs(flipped)).max(axis=1))


def _members(groups: np.ndarray) -> Array:
    """(G, R) membership of trials in conditions; one group where no condition has replicates."""
    names, counts = np.unique(groups, return_counts=True)
    if counts.max() < 2:
        return np.ones((1, groups.size))
    return np.asarray(groups[None] == names[:, None], dtype=float)


def sign_patterns(trials: int, flips: int, seed: int) -> Array:
    """(S, R) signs of whole trials: all 2^R where they are few, else so many at random."""
    if trials <= criteria.ALL_FLIPS:
        return np.array(list(itertools.product((1.0, -1.0), repeat=trials)))
    return np.asarray(np.random.default_rng(seed).choice((1.0, -1.0), size=(flips, trials)))


def _statistics(means: Array, kinds: Array, signs: Array, members: Array) -> tuple[Array, Array]:
    """(S, K) statistics and standard errors after each of S flips (S, R), with trials in groups (G, R)."""
    finite = np.isfinite(means)
    known = np.nan_to_num(means)
    total, explained, signed = (known**2).sum(axis=1), 0.0, 0.0
    freedom = np.zeros(len(means))
    for member in members:
        count = finite @ member
        sums = (signs * member) @ known.T
        explained = explained + sums**2 / np.maximum(count, 1.0)
        signed = signed + sums
        freedom += np.maximum(count - 1.0, 0.0)
    spread = (total - explained) / np.maximum(freedom, 1.0)
    spread = np.maximum(spread, 1e-12 * total / np.maximum(finite.sum(axis=1), 1))
    pooled = np.empty_like(spread)
    for kind in np.unique(kinds, axis=0):
        mine = (kinds == kind).all(axis=1)
        pooled[:, mine] = np.median(spread[:, mine], axis=1, keepdims=True)
    shrunk = (criteria.POOLED_TRIALS * pooled + freedom * spread) / (criteria.POOLED_TRIALS + freedom)
    t = np.sign(signed) * np.sqrt(explained / np.maximum(shrunk, 1e-300))
    return t, np.sqrt(shrunk / np.maximum(finite.sum(axis=1), 1))


def channel_sizes(before: Fit, after: Fit) -> tuple[ChannelSize, ...]:
    """The misfit of each channel with two models of one problem, against the tolerance.

    It is the root mean square over trials of the mean residual in a cell, so that what trials miss in unlike ways
    counts as what they share does; the cell in which it is largest stands for the channel.
    """
    old, new, tolerance = _misses(before), _misses(after), tolerances(before.model.problem)
    return tuple(ChannelSize(channel, old[channel], new[channel], tolerance[channel]) for channel in old)


def tolerances(problem: TrialsProblem) -> dict[str, float]:
    """The stated tolerance of each channel, N or m."""
    force = criteria.TOLERANCE_FORCE * max(condition.around.peak_force for condition in problem.study.conditions)
    channels = dict.fromkeys(problem.study.channels)
    return {name: force if name.startswith("force") else criteria.TOLERANCE_MARKERS for name in channels}


def too_small(problem: TrialsProblem) -> Array:
    """(C,) size of each signal, N or m, up to which a mean is no disagreement."""
    tolerance = tolerances(problem)
    return np.array([criteria.TOO_SMALL * tolerance[channel] for channel in problem.study.channels])


def within_tolerance(fitted: Fit) -> bool:
    """Whether a model misses by no more than the stated tolerance in every channel."""
    return all(each.after <= each.tolerance for each in channel_sizes(fitted, fitted))


def misses_nothing(fitted: Fit) -> bool:
    """Whether force alone is measured, and missed nowhere by more than finite elements and laws are right to.

    Neither in the mean of a cell nor, surely, in the mean of trials at a row or of 2, 4... rows that follow each
    other: a pull-off is a tenth of a second in an air of some, and a screw's pitch has no mean.
    """
    problem = fitted.model.problem
    if problem.study.layout is not None:
        return False
    least = criteria.LEAST_FORCE * max(float(np.abs(trial.signals[:, 0]).max()) for trial in problem.trials)
    if max(_misses(fitted).values()) >= least:
        return False
    force: dict[int, list[Array]] = {}
    for trial, residual in zip(problem.trials, _residuals(fitted), strict=True):
        force.setdefault(trial.condition, []).append(residual[:, 0])
    return all(_surely_missed(np.array(trials)) < least for trials in force.values())


def _surely_missed(residuals: Array) -> float:
    """By how much trials (R, n) miss at least, in the mean, at a row or in a run of up to `LONGEST_RUN` of them."""
    trials, rows = residuals.shape
    if trials < 2:
        return 0.0  # what it scatters by is not known
    most, length, total = 0.0, 1, np.cumsum(np.pad(residuals, ((0, 0), (1, 0))), axis=1)
    while length <= min(criteria.LONGEST_RUN, rows):
        means = (total[:, length:] - total[:, :-length]) / length
        error = np.sqrt(means.var(axis=0, ddof=1).mean() / trials)
        most = max(most, float(np.abs(means.mean(axis=0)).max() - criteria.SURELY_MISSED * error))
        length *= 2
    return most


def _misses(fitted: Fit) -> dict[str, float]:
    """The largest miss of each channel, N or m."""
    problem = fitted.model.problem
    table = cell_means(problem, _residuals(fitted), cells_of(problem))
    out = dict.fromkeys(problem.study.channels, 0.0)
    for cell, means in zip(table.cells, table.means, strict=True):
        for number in cell.rows:
            own = means[np.asarray(table.groups) == number]
            channel = problem.study.channels[cell.signal]
            out[channel] = max(out[channel], float(np.sqrt(np.mean(own**2))))
    return out


def _residuals(fitted: Fit) -> list[Array]:
    signals = fitted.model.signals(fitted.vector, fitted.nuisance)
    return [trial.signals - signal for trial, signal in zip(fitted.model.problem.trials, signals, strict=True)]
