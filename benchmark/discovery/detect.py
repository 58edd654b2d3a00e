"""Is there a disagreement, and where: the base's residuals tested in cells, refitted once on the clean ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery.cells import Cell, CellTable, FlipTest, cell_means, cells_of, flip_test, projected_residuals
from benchmark.discovery.fit import Fit, fit
from benchmark.discovery.model import Model
from benchmark.discovery.result import PHASES, Array, Place
from benchmark.discovery.settings import Settings

MOST_CELLS = 0.6
"""Where more than this share of the cells is flagged there is nothing clean to refit on."""


@dataclass(frozen=True, eq=False)
class Detection:
    """Cells and their test, on the fit that used the clean cells, and p before that refit."""

    table: CellTable
    test: FlipTest
    p: float
    trend: Array


def detect(fitted: Fit, settings: Settings) -> Detection:
    """Test the residuals of a fit."""
    first = _tested(fitted, settings)
    p = first[1].p_any
    flagged = first[1].p < settings.level
    last = first
    if flagged.any() and flagged.mean() < MOST_CELLS:
        last = _tested(_refitted(fitted, first[0], flagged), settings, full=fitted)
    return Detection(*last, p=p, trend=_trend(fitted, first[0]))


def _tested(fitted: Fit, settings: Settings, full: Fit | None = None) -> tuple[CellTable, FlipTest]:
    problem = (full or fitted).model.problem
    table = cell_means(problem, projected_residuals(fitted), cells_of(problem))
    return table, flip_test(table, settings.flips, settings.seed)


def _refitted(fitted: Fit, table: CellTable, flagged: NDArray[np.bool_]) -> Fit:
    """The model fitted on the rows of cells that are not flagged."""
    problem = fitted.model.problem
    masks = [np.ones(c.signals.shape[1:], dtype=bool) for c in problem.study.conditions]
    for cell, bad in zip(table.cells, flagged, strict=True):
        if bad:
            for condition, rows in cell.rows.items():
                masks[condition][rows, cell.signal] = False
    clean = replace(problem, mask=tuple(masks))
    model = Model(clean, fitted.model.effects)
    return fit(model, fitted.vector, fitted.nuisance, most=4)


def _trend(fitted: Fit, table: CellTable) -> Array:
    """(K,) t of the slope of each cell's mean over the trial number."""
    numbers = np.array([trial.number for trial in fitted.model.problem.trials], dtype=float)
    out = np.zeros(len(table.cells))
    for k, row in enumerate(table.means):
        known = np.isfinite(row)
        if known.sum() < 4:
            continue
        x = numbers[known] - numbers[known].mean()
        y = row[known] - row[known].mean()
        slope = float(x @ y) / float(x @ x)
        rest = y - slope * x
        error = np.sqrt(float(rest @ rest) / (known.sum() - 2) / float(x @ x))
        out[k] = slope / max(error, 1e-300)
    return out


def places(fitted: Fit, detection: Detection, level: float) -> tuple[Place, ...]:
    """Flagged cells in words and numbers, marker combinations under their channel, largest t first."""
    problem = fitted.model.problem
    study, test = problem.study, detection.test
    ranges = signal_ranges(fitted)
    found: dict[tuple[object, ...], tuple[float, Place]] = {}
    for k, cell in enumerate(detection.table.cells):
        if test.p[k] >= level:
            continue
        number, size = _largest(fitted, detection.table.means[k], cell)
        condition = study.conditions[number]
        depth = np.median(condition.depth[:, cell.rows[number]], axis=0)
        place = Place(
            channel=study.channels[cell.signal],
            phase=PHASES[cell.phase],
            condition=condition.name,
            cycle=cell.cycle,
            depth=(float(depth.min()), float(depth.max())),
            size=size,
            percent_of_signal=float(100.0 * abs(size) / ranges[cell.signal]),
            p=float(test.p[k]),
        )
        key = (place.channel, place.phase, place.condition, place.cycle, cell.part)
        if key not in found or abs(test.t[k]) > found[key][0]:
            found[key] = (abs(float(test.t[k])), place)
    return tuple(place for _, place in sorted(found.values(), key=lambda pair: -pair[0]))


def _largest(fitted: Fit, means: Array, cell: Cell) -> tuple[int, float]:
    """The condition where a cell's mean is largest, and that mean."""
    groups = np.array([trial.condition for trial in fitted.model.problem.trials])
    each = {number: float(means[groups == number].mean()) for number in cell.rows}
    number = max(each, key=lambda key: abs(each[key]))
    return number, each[number]


def signal_ranges(fitted: Fit) -> Array:
    """(C,) largest simulated range of each signal, all marker combinations on the largest of them."""
    signals = fitted.model.signals(fitted.vector, fitted.nuisance)
    ranges = np.max([np.ptp(one, axis=0) for one in signals], axis=0)
    measured = np.max([np.ptp(trial.signals, axis=0) for trial in fitted.model.problem.trials], axis=0)
    ranges = np.maximum(ranges, 1e-12)
    if ranges.size > 1:
        ranges[1:] = max(ranges[1:].max(), 0.3 * measured[1:].max())
    return np.asarray(ranges)


def smallest_visible(fitted: Fit, detection: Detection) -> dict[str, float]:
    """For each channel the smallest mean residual that would have been flagged, N or m."""
    channels = fitted.model.problem.study.channels
    out: dict[str, float] = {}
    for k, cell in enumerate(detection.table.cells):
        size = float(detection.test.critical * detection.test.error[k])
        channel = channels[cell.signal]
        out[channel] = min(out.get(channel, np.inf), size)
    return out


def unexplained(detection: Detection) -> float:
    """What the cells' means hold beyond chance, in squared standard errors."""
    means = detection.table.means
    count = np.isfinite(means).sum(axis=1)
    return float(np.sum(detection.test.t**2) - count.size)
