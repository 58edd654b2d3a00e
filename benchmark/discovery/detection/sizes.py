"""How large a misfit is, whatever its p: a model that misses by more than the stated tolerance is never called good."""

from __future__ import annotations

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.detection.cells import cell_means, cells_of
from benchmark.discovery.discovery_result import ChannelSize


def channel_sizes(before: Fit, after: Fit) -> tuple[ChannelSize, ...]:
    """The misfit of each channel with two models of one problem, against the tolerance.

    It is the root mean square over trials of the mean residual in a cell, so that what trials miss in unlike ways
    counts as what they share does; the cell in which it is largest stands for the channel.
    """
    peak = max(condition.around.peak_force for condition in before.model.problem.study.conditions)
    old, new = _misses(before), _misses(after)
    return tuple(
        ChannelSize(
            channel,
            old[channel],
            new[channel],
            criteria.TOLERANCE_FORCE * peak if channel.startswith("force") else criteria.TOLERANCE_MARKERS,
        )
        for channel in old
    )


def within_tolerance(fitted: Fit) -> bool:
    """Whether a model misses by no more than the stated tolerance in every channel."""
    return all(each.after <= each.tolerance for each in channel_sizes(fitted, fitted))


def _misses(fitted: Fit) -> dict[str, float]:
    """The largest miss of each channel, N or m."""
    problem = fitted.model.problem
    signals = fitted.model.signals(fitted.vector, fitted.nuisance)
    residuals = [trial.signals - signal for trial, signal in zip(problem.trials, signals, strict=True)]
    table = cell_means(problem, residuals, cells_of(problem))
    out = dict.fromkeys(problem.study.channels, 0.0)
    for cell, means in zip(table.cells, table.means, strict=True):
        for number in cell.rows:
            own = means[np.asarray(table.groups) == number]
            channel = problem.study.channels[cell.signal]
            out[channel] = max(out[channel], float(np.sqrt(np.mean(own**2))))
    return out
