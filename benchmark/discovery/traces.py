"""Curves for pictures: measured, before and after, with the replicates' scatter."""

from __future__ import annotations

import numpy as np

from benchmark.discovery.calibrate import pure_errors
from benchmark.discovery.fit import Fit
from benchmark.discovery.gap import HeldOut
from benchmark.discovery.result import Array, Trace


def traces(base: Fit, held: HeldOut) -> tuple[Trace, ...]:
    """One trace a trial and channel; of a channel's marker combinations the liveliest."""
    problem = base.model.problem
    study = problem.study
    errors = pure_errors(base)
    shown = _shown(base)
    out = []
    for index, trial in enumerate(problem.trials):
        condition = study.conditions[trial.condition]
        mates = [k for k, other in enumerate(problem.trials) if other.condition == trial.condition]
        noise = np.sqrt(np.mean([errors[k] ** 2 for k in mates], axis=0))
        for channel, signal in shown.items():
            absent = trial.count[:, signal] <= 0.0
            measured = np.where(absent, np.nan, trial.signals[:, signal])
            before, after = (_curve(trial.signals, rows[index], signal) for rows in (held.before, held.after))
            out.append(
                Trace(
                    trial.name,
                    condition.name,
                    channel,
                    True,
                    trial.motion.time,
                    trial.motion.depth,
                    measured,
                    before,
                    after,
                    np.nan_to_num(noise[:, signal]),
                )
            )
    return tuple(out)


def _curve(measured: Array, residual: Array, signal: int) -> Array:
    return np.asarray(measured[:, signal] - residual[:, signal])


def _shown(base: Fit) -> dict[str, int]:
    """The signal that stands for each channel."""
    study = base.model.problem.study
    size = np.max([np.ptp(trial.signals, axis=0) for trial in base.model.problem.trials], axis=0)
    out: dict[str, int] = {}
    for k, channel in enumerate(study.channels):
        if channel not in out or size[k] > size[out[channel]]:
            out[channel] = k
    return out
