"""Where model and measurement disagree: cells that were flagged, and where accepted effects show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import EffectModel, Fit, White, nuisance_precision
from benchmark.discovery.base.trials_problem import followed
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.cells import Cell, one_sided
from benchmark.discovery.detection.disagreement import Detection, shared_by
from benchmark.discovery.discovery_result import PHASES, Array, Place

BOTH = ("radial_x", "radial_y")
"""Combinations whose change is as much tangential as radial."""


def places(base: Fit, before: Fit, chosen: Fit, detection: Detection, settings: Settings) -> tuple[Place, ...]:
    """Where the effects of `chosen` show, then cells flagged without it in channels and phases not among these.

    Sizes are of `before`, the model without effects that pictures and gap show; `detection` is of `base`.
    """
    changes = None if chosen is base else effect_changes(chosen)
    flagged = flagged_places(base, detection, settings.level, before, changes)
    if changes is None:
        return flagged
    first = effect_places(chosen, before, changes, settings)
    have = {(place.channel, place.phase) for place in first}
    return (*first, *(place for place in flagged if (place.channel, place.phase) not in have))


def shared_places(fitted: Fit, settings: Settings) -> tuple[Place, ...]:
    """Channels and phases in which trials surely share a misfit row by row, the largest first.

    The size is the root mean square of what they share, in the condition where it is largest.
    """
    count = len(fitted.model.problem.trials)
    found = [
        (channel, signals, phase) for channel, signals in _channels(fitted).items() for phase in range(len(PHASES))
    ]
    picks = [[_picked(fitted, i, phase, signals) for i in range(count)] for _, signals, phase in found]
    sizes, p = shared_by(fitted, picks, settings)
    view = _View.of(fitted, None)
    order = [k for k in np.argsort(-sizes) if p[k] < settings.level and sizes[k] > 0.0]
    shared = (view.shared(*found[k], p=float(p[k])) for k in order)
    return tuple(place for place in shared if place is not None)


def flagged_places(
    fitted: Fit, detection: Detection, level: float, before: Fit | None = None, changes: Sequence[Array] | None = None
) -> tuple[Place, ...]:
    """Flagged cells in words and numbers, marker combinations under their channel, largest t first.

    Sizes are of the residual of `before`, by default of `fitted` itself; `changes` is what effects add to the signals.
    """
    test, view = detection.test, _View.of(before or fitted, changes)
    found: dict[tuple[object, ...], tuple[float, Place]] = {}
    for k, cell in enumerate(detection.table.cells):
        if test.p[k] >= level:
            continue
        number = _largest(fitted, detection.table.means[k], cell)
        place = view.place((number, cell.signal), cell.rows[number], cell.cycle, float(test.p[k]))
        key = (place.channel, place.phase, place.condition, place.cycle, cell.part)
        if key not in found or abs(test.t[k]) > found[key][0]:
            found[key] = (abs(float(test.t[k])), place)
    return tuple(place for _, place in sorted(found.values(), key=lambda pair: -pair[0]))


def _largest(fitted: Fit, means: Array, cell: Cell) -> int:
    """The condition where a cell's mean is largest."""
    groups = np.array([trial.condition for trial in fitted.model.problem.trials])
    return max(cell.rows, key=lambda number: abs(float(means[groups == number].mean())))


def effect_changes(chosen: Fit) -> list[Array]:
    """(n, C) of each trial: what the effects of a fit add to its signals."""
    bare = EffectModel(chosen.model.problem, ())
    with_them = chosen.model.signals(chosen.vector, chosen.nuisance)
    without = bare.signals(chosen.vector[: bare.size], chosen.nuisance)
    return [more - less for more, less in zip(with_them, without, strict=True)]


def effect_places(chosen: Fit, before: Fit, changes: Sequence[Array], settings: Settings) -> tuple[Place, ...]:
    """Channels and phases in which the effects of a fit show, the clearest first.

    The change is what the model with the effects gives more than without them, less what a base could follow that is
    wrong in modulus, tool radius, exponent and width alone. Its norm is that of its whitened mean over all conditions;
    the residual without the effects must lie along it, trial by trial. Where it is small everywhere, the largest are
    shown. The size told is the residual of `before`.
    """
    problem = chosen.model.problem
    bare = EffectModel(problem, ())
    without = bare.signals(chosen.vector[: bare.size], chosen.nuisance)
    white = White(problem)
    moved = _unfollowed(chosen, [white.flat(i, change) for i, change in enumerate(changes)])
    residual = _unfollowed(chosen, white.residuals(without))
    found: list[_Shown] = []
    for channel, signals in _channels(chosen).items():
        for phase in range(len(PHASES)):
            pick = [_picked(chosen, i, phase, signals) for i in range(len(changes))]
            along = [float(np.sum(m[p] * r[p])) for m, r, p in zip(moved, residual, pick, strict=True)]
            found.append(_Shown(channel, phase, signals, _size(chosen, moved, pick), np.array(along)))
    least = min(criteria.SHOWN, criteria.SHOWN_OF_LARGEST * max(each.size for each in found))
    shown = [each for each in found if each.size >= least and each.size > 0.0]
    if not shown:
        return ()
    groups = np.array([trial.condition for trial in problem.trials])
    p = one_sided(np.array([each.along for each in shown]), groups, settings.flips, settings.seed)
    clear = [(each, float(value)) for each, value in zip(shown, p, strict=True) if value < settings.level]
    clear.sort(key=lambda pair: -pair[0].size)
    view = _View.of(before, changes)
    return tuple(_largest_change(view, changes, each, value) for each, value in clear)


@dataclass(frozen=True, eq=False)
class _Shown:
    """A channel and phase in which effects show: size in standard deviations, residual along the change (R,)."""

    channel: str
    phase: int
    signals: Sequence[int]
    size: float
    along: Array


def _unfollowed(fitted: Fit, rows: Sequence[Array]) -> list[Array]:
    """White rows (N,) of each trial less what `followed` and the trial's own nuisances can take up, as (n, C)."""
    problem = fitted.model.problem
    weight = np.diag(nuisance_precision(problem))
    shapes = [k for k, name in enumerate(problem.shapes) if followed(name)]
    columns = [each[:, shapes] for each in fitted.columns.vector]

    def own(i: int, of: Array) -> Array:
        n = fitted.columns.nuisance[i]
        return np.asarray(of - n @ np.linalg.solve(n.T @ n + weight, n.T @ of))

    held = [own(i, row) for i, row in enumerate(rows)]
    matrix = sum((c.T @ own(i, c) for i, c in enumerate(columns)), np.zeros((len(shapes),) * 2))
    side = sum((c.T @ h for c, h in zip(columns, held, strict=True)), np.zeros(len(shapes)))
    amount = np.linalg.lstsq(matrix, side, rcond=1e-9)[0]
    wide = len(problem.study.names)
    return [(h - own(i, columns[i] @ amount)).reshape(-1, wide) for i, h in enumerate(held)]


def _channels(fitted: Fit) -> dict[str, list[int]]:
    """Signals of each channel by their numbers."""
    study = fitted.model.problem.study
    out: dict[str, list[int]] = {}
    for number, (name, channel) in enumerate(zip(study.names, study.channels, strict=True)):
        out.setdefault(channel, []).append(number)
        if name in BOTH:
            out.setdefault("marker_tangential", []).append(number)
    return out


def _picked(fitted: Fit, index: int, phase: int, signals: Sequence[int]) -> np.ndarray:
    """Mask (n, C) of a trial's rows in a phase and signals."""
    problem = fitted.model.problem
    rows = problem.study.conditions[problem.trials[index].condition].phase == phase
    mask = np.zeros((rows.size, len(problem.study.names)), dtype=bool)
    mask[:, signals] = rows[:, None]
    return mask


def _size(fitted: Fit, moved: Sequence[Array], pick: Sequence[np.ndarray]) -> float:
    """Norm of the mean change over trials of a condition, in its standard deviations, all conditions together."""
    groups = np.array([trial.condition for trial in fitted.model.problem.trials])
    total = 0.0
    for number in np.unique(groups):
        mine = np.flatnonzero(groups == number).tolist()
        mean = np.mean([np.where(pick[i], moved[i], 0.0) for i in mine], axis=0)
        total += len(mine) * float(np.sum(mean**2))
    return float(np.sqrt(total))


def _largest_change(view: _View, changes: Sequence[Array], shown: _Shown, p: float) -> Place:
    """The place in the condition and signal where the change is largest."""
    best, at = 0.0, (0, 0)
    conditions = view.fitted.model.problem.study.conditions
    for number, condition in enumerate(conditions):
        rows = condition.phase == shown.phase
        if not rows.any():
            continue
        for signal in shown.signals:
            size = view.mean(changes, (number, signal), rows)
            if abs(size) >= abs(best):
                best, at = size, (number, signal)
    rows = conditions[at[0]].phase == shown.phase
    place = view.place(at, rows, int(conditions[at[0]].cycle[rows].min()), p)
    return replace(place, channel=shown.channel)


@dataclass(frozen=True, eq=False)
class _View:
    """The model without effects as readers see it: its residuals (n, C) by trial, what effects add, ranges (C,)."""

    fitted: Fit
    residuals: Sequence[Array]
    changes: Sequence[Array] | None
    ranges: Array

    @staticmethod
    def of(fitted: Fit, changes: Sequence[Array] | None) -> _View:
        signals = fitted.model.signals(fitted.vector, fitted.nuisance)
        trials = fitted.model.problem.trials
        residuals = [trial.signals - signal for trial, signal in zip(trials, signals, strict=True)]
        return _View(fitted, residuals, changes, _signal_ranges(fitted))

    def mean(self, rows_of: Sequence[Array], at: tuple[int, int], rows: np.ndarray) -> float:
        """Mean over rows (n,) bool and trials of a condition of one signal (`at`), rows weighted by their samples."""
        number, signal = at
        mine = [i for i, trial in enumerate(self.fitted.model.problem.trials) if trial.condition == number]
        weights = [self.fitted.model.problem.trials[i].count[rows, signal] for i in mine]
        total = [
            float(np.sum(rows_of[i][rows, signal] * weight) / max(weight.sum(), 1e-12))
            for i, weight in zip(mine, weights, strict=True)
        ]
        return float(np.mean(total))

    def shared(self, channel: str, signals: Sequence[int], phase: int, *, p: float) -> Place | None:
        """What trials of a condition share row by row in a phase: of its signals and conditions where that is most.

        None where no condition shows any, as where no row has samples of all its trials.
        """
        problem = self.fitted.model.problem
        sizes: dict[tuple[int, int], float] = {}
        for number, condition in enumerate(problem.study.conditions):
            mine = [i for i, trial in enumerate(problem.trials) if trial.condition == number]
            for signal in signals:
                counted = np.all([problem.trials[i].count[:, signal] > 0.0 for i in mine], axis=0)
                part = np.array([self.residuals[i][counted & (condition.phase == phase), signal] for i in mine])
                if part.size and len(mine) > 1:
                    square = part.mean(axis=0) ** 2 - part.var(axis=0, ddof=1) / len(mine)
                    sizes[number, signal] = float(square.mean())
        at = max(sizes, key=lambda key: sizes[key], default=None)
        if at is None or not sizes[at] > 0.0:
            return None
        condition = problem.study.conditions[at[0]]
        rows = condition.phase == phase
        place = self.place(at, rows, int(condition.cycle[rows].min()), p)
        size = float(np.sqrt(sizes[at]))
        return replace(
            place, channel=channel, size=size, percent_of_signal=100.0 * size / self.ranges[at[1]], either_way=True
        )

    def place(self, at: tuple[int, int], rows: np.ndarray, cycle: int, p: float) -> Place:
        """Rows (n,) of a condition and signal (`at`) as a place."""
        study, (number, signal) = self.fitted.model.problem.study, at
        condition = study.conditions[number]
        depth = np.median(condition.depth[:, rows], axis=0)
        residual = self.mean(self.residuals, at, rows)
        return Place(
            channel=study.channels[signal],
            phase=PHASES[condition.phase[rows][0]],
            condition=condition.name,
            cycle=cycle,
            depth=(float(depth.min()), float(depth.max())),
            size=residual if self.changes is None else self.mean(self.changes, at, rows),
            percent_of_signal=float(100.0 * abs(residual) / self.ranges[signal]),
            p=p,
            residual=None if self.changes is None else residual,
        )


def _signal_ranges(fitted: Fit) -> Array:
    """(C,) largest simulated range of each signal, all marker combinations on the largest of them."""
    signals = fitted.model.signals(fitted.vector, fitted.nuisance)
    ranges = np.max([np.ptp(one, axis=0) for one in signals], axis=0)
    measured = np.max([np.ptp(trial.signals, axis=0) for trial in fitted.model.problem.trials], axis=0)
    ranges = np.maximum(ranges, 1e-12)
    if ranges.size > 1:
        ranges[1:] = max(ranges[1:].max(), 0.3 * measured[1:].max())
    return np.asarray(ranges)
