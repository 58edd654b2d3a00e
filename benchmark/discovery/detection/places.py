"""Where accepted effects show: what they change that the base cannot follow, cell by cell, tested along that change."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.discovery.base.effect_model import Fit, Model, White, nuisance_precision
from benchmark.discovery.base.trials_problem import FOLLOWED
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.cells import one_sided
from benchmark.discovery.detection.disagreement import signal_ranges
from benchmark.discovery.discovery_result import PHASES, Array, Place

LEAST = 4.0
"""Standard deviations of the trials' mean from which a change is shown."""
BOTH = ("radial_x", "radial_y")
"""Combinations whose change is as much tangential as radial."""


def places_of(chosen: Fit, settings: Settings) -> tuple[Place, ...]:
    """Channels and phases in which the effects of a fit show, the clearest first.

    The change is what the model with the effects gives more than without them, less what a base could follow that is
    wrong in modulus, tool radius, exponent and width alone. Its size is the norm of its whitened mean over all
    conditions; the residual without the effects must lie along it, trial by trial.
    """
    problem = chosen.model.problem
    bare = Model(problem, ())
    with_them = chosen.model.signals(chosen.vector, chosen.nuisance)
    without = bare.signals(chosen.vector[: bare.size], chosen.nuisance)
    changes = [more - less for more, less in zip(with_them, without, strict=True)]
    white = White(problem)
    moved = _unfollowed(chosen, [white.flat(i, change) for i, change in enumerate(changes)])
    residual = _unfollowed(chosen, white.residuals(without))
    found = []
    for channel, signals in _channels(chosen).items():
        for phase in range(len(PHASES)):
            pick = [_picked(chosen, i, phase, signals) for i in range(len(changes))]
            size = _size(chosen, moved, pick)
            if size >= LEAST:
                along = [float(np.sum(m[p] * r[p])) for m, r, p in zip(moved, residual, pick, strict=True)]
                found.append((size, channel, phase, signals, along))
    if not found:
        return ()
    groups = np.array([trial.condition for trial in problem.trials])
    p = one_sided(np.array([each[-1] for each in found]), groups, settings.flips, settings.seed)
    shown = [(*each[:4], value) for each, value in zip(found, p, strict=True) if value < settings.level]
    shown.sort(key=lambda each: -each[0])
    ranges = signal_ranges(chosen)
    return tuple(_place(chosen, changes, ranges, each[1], each[2], each[3], float(each[4])) for each in shown)


def _unfollowed(fitted: Fit, rows: Sequence[Array]) -> list[Array]:
    """White rows (N,) of each trial less what `FOLLOWED` and the trial's nuisances can take up, as (n, C)."""
    problem = fitted.model.problem
    weight = np.diag(nuisance_precision(problem))
    shapes = [k for k, name in enumerate(problem.shapes) if name in FOLLOWED]
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


def _place(
    fitted: Fit, changes: Sequence[Array], ranges: Array, channel: str, phase: int, signals: Sequence[int], p: float
) -> Place:
    """The place in the condition and signal where the change is largest."""
    problem = fitted.model.problem
    best = (0.0, 0, 0)
    for number, condition in enumerate(problem.study.conditions):
        rows = condition.phase == phase
        mine = [i for i, trial in enumerate(problem.trials) if trial.condition == number]
        if not rows.any():
            continue
        for signal in signals:
            size = float(np.mean([changes[i][rows, signal].mean() for i in mine]))
            if abs(size) >= abs(best[0]):
                best = (size, number, signal)
    size, number, signal = best
    condition = problem.study.conditions[number]
    rows = condition.phase == phase
    depth = np.median(condition.depth[:, rows], axis=0)
    return Place(
        channel=channel,
        phase=PHASES[phase],
        condition=condition.name,
        cycle=int(condition.cycle[rows].min()),
        depth=(float(depth.min()), float(depth.max())),
        size=size,
        percent_of_signal=float(100.0 * abs(size) / ranges[signal]),
        p=p,
    )
