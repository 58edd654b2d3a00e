"""Holds in a trial: stretches of constant depth under load, and by how much the force changes in them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmark.fitting.contact import LEAST_EVIDENCE, NOISES, evidence_of, sample_noise, travel, without_spikes
from benchmark.fitting.curve import Array
from benchmark.fitting.trial import TrialData

STILL = 0.005
"""Depth within this fraction of the travel counts as held."""
LEAST_SHARE = 0.05
"""Least length of a hold as a fraction of the trial's duration; it also needs five rows."""
LOADED = 0.2
"""Least force of a hold above the level in the air, as a fraction of the trial's rise."""
SEEN = 2.0
"""A loss of force in a hold counts above this, in %, where a decay stands out of the noise."""
CLEAR = 10.0
"""A larger loss, in %, needs only to be above twelve standard deviations of the sample-to-sample noise."""
SHARES = (0.02, 0.05, 0.1, 0.2, 0.5, 2.0)
"""Time constants of the decays that are looked for, as fractions of the hold."""


@dataclass(frozen=True)
class Hold:
    """A hold: `start` and `end` in s, `depth` in m, force lost in % of the force above the unloaded level.

    `seen` says whether the loss stands out of the noise.
    """

    start: float
    end: float
    depth: float
    decay_percent: float
    seen: bool

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "start_s": self.start,
            "end_s": self.end,
            "depth_mm": 1e3 * self.depth,
            "decay_percent": self.decay_percent,
            "seen": self.seen,
        }


def largest_decay(trial: TrialData) -> Hold | None:
    """Return the loaded hold in which the force falls most, None where the depth is never held under load."""
    level = float(np.median(trial.force[trial.depth <= np.quantile(trial.depth, 0.05)]))
    rise = float(without_spikes(trial.force).max()) - level
    holds = [_hold(trial, rows, level) for rows in _still(trial) if _loaded(trial.force[rows], level, rise)]
    return max(holds, key=lambda hold: hold.decay_percent, default=None)


def _still(trial: TrialData) -> Iterator[slice]:
    """Rows of each stretch in which the depth stays put, in order."""
    tolerance = STILL * travel(trial.depth)
    shortest = LEAST_SHARE * float(trial.time[-1] - trial.time[0])
    first = 0
    while first < trial.rows - 4:
        moved = np.abs(trial.depth[first:] - trial.depth[first]) > tolerance
        end = first + int(np.argmax(moved)) if moved.any() else trial.rows
        if end - first >= 5 and trial.time[end - 1] - trial.time[first] >= shortest:
            yield slice(first, end)
            first = end
        else:
            first += 1


def _loaded(force: Array, level: float, rise: float) -> bool:
    return rise > 0.0 and float(force.max()) - level >= LOADED * rise


def _hold(trial: TrialData, rows: slice, level: float) -> Hold:
    """Compare the highest force of the first quarter with the mean of the last tenth."""
    force = without_spikes(trial.force)[rows]
    before = float(force[: max(2, len(force) // 4)].max())
    after = float(force[-max(2, len(force) // 10) :].mean())
    decay = 100.0 * (before - after) / (float(force.max()) - level)
    elapsed = (trial.time[rows] - trial.time[rows][0]) / (trial.time[rows][-1] - trial.time[rows][0])
    falls = [evidence_of(np.exp(-elapsed / share), force) for share in SHARES]
    clear = decay > CLEAR and before - after > 2.0 * NOISES * sample_noise(trial.force)
    seen = bool(clear or (decay > SEEN and max(falls) >= LEAST_EVIDENCE))
    return Hold(float(trial.time[rows][0]), float(trial.time[rows][-1]), float(trial.depth[rows].mean()), decay, seen)
