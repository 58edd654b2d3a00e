"""Where a trial's force rises: bounds and a start for the contact onset, and whether there is contact."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmark.identification.trial_data import TrialData
from benchmark.response.force_curve import Array
from benchmark.response.noise import lag_one, whitened

RISEN = 0.01
"""Force above its level at the least depth, as a fraction of its rise, that noise or a little contact may be."""
NOISES = 6.0
"""The same in standard deviations of the force's sample-to-sample noise."""
LATEST = 0.15
"""The same as a fraction of its rise where the force rises steadily before, as by a drift in the air."""
STEADY, STRAIGHT = 0.2, 1.3
"""What a steady force rises at least from the first third of the way there to the middle one, as a fraction of what it
rises on all of it; and from the middle third to the last one at most, over the former: a drift, not a soft contact."""
LEAST_EVIDENCE = 5.0
"""Least t of the stiffness, with autocorrelated noise, that counts as contact."""
LEAST_TRAVEL = 1e-6
"""A trial whose depth stays within this range (m) has no motion."""
ONSETS = 41
END_ROWS, END_TRAVEL = 0.05, 0.02
"""Share of the rows that are the shallowest, and the deepest; and of the travel, within which the former are."""


@dataclass(frozen=True)
class ContactRange:
    """What the data allow of a trial's contact.

    Attributes
    ----------
    low, high : float
        Range of the contact onset, m on the trial's own depth scale.
    reference : float
        Depth at which the trial is least deep, m.
    rest_low, rest_high : float
        Range of the force there, N.
    """

    low: float
    high: float
    reference: float
    rest_low: float
    rest_high: float


@dataclass(frozen=True)
class Start:
    """Best linear fit over a grid of onsets: stiffness factor, force at the reference depth (N), onset (m).

    `evidence` is the t of the stiffness with autocorrelated noise, or of the force's rise where that is larger: a
    force that follows another law than the curve is none the less a contact.
    """

    stiffness: float
    rest: float
    onset: float
    evidence: float


def travel(depth: Array) -> float:
    """Range of the depth (n,), m."""
    return float(np.ptp(depth))


def sample_noise(force: Array) -> float:
    """Robust standard deviation of the sample-to-sample noise of a force (n,), N, by second differences."""
    return float(np.median(np.abs(np.diff(force, 2))) / (0.6745 * np.sqrt(6.0)))


def without_spikes(force: Array) -> Array:
    """Force (n,), N, with bad samples replaced by the running median of five.

    Bad is what leaves that median by more than a quarter of its range; up to two neighbours are recognised.
    """
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(force, 2, mode="reflect"), 5)
    calm = np.median(windows, axis=1)
    return np.where(np.abs(force - calm) > 0.25 * np.ptp(calm), calm, force)


def contact_range(depth: Array, force: Array) -> ContactRange:
    """Range in which the data allow the contact onset, and the force where the trial is least deep.

    Contact has begun at the latest where the force has left its level at the least depth by 1 % of its rise
    and six standard deviations of its noise, for the last time before the largest force; by 15 % where it
    rises steadily up to there, for it may have drifted in the air. It began at the earliest as far above the
    row before the first of these as the deepest row lies below it (a weight that is put on within one row has
    the whole press between the two), and no more than a tenth of the travel above the least depth. The force
    at the least depth is its median there, within twice the first margin.

    Parameters
    ----------
    depth, force : (n,)
        m and N.
    """
    shallow = _shallowest(depth)
    calm = without_spikes(force)
    level, peak = float(np.median(force[shallow])), int(np.argmax(calm))
    rise = float(calm[peak] - level)
    margin = max(NOISES * sample_noise(force), RISEN * rise)
    left = _left(calm[:peak], level + margin)
    late = _left(calm[:peak], level + max(margin, LATEST * rise)) if _steady(calm[:left], margin) else left
    before, risen = (float(depth[left - 1]), float(depth[left])) if left else (float(depth.min()),) * 2
    low = max(float(depth.min()) - 0.1 * travel(depth), 2.0 * before - float(depth.max()))
    high = max(risen, float(depth[late]) if late else risen, low + 1e-3 * travel(depth))
    margin = max(margin, np.finfo(float).tiny)
    return ContactRange(low, high, float(np.median(depth[shallow])), level - 2.0 * margin, level + 2.0 * margin)


def _shallowest(depth: Array) -> NDArray[np.bool_]:
    """(n,) the shallowest rows: `END_ROWS` of them, and none far above the least depth (n,), m.

    Of a record that begins at the touch and holds for long these would else be the whole way down.
    """
    ends = np.quantile(depth, END_ROWS), depth.min() + END_TRAVEL * travel(depth)
    return np.asarray(depth <= min(ends))


def _left(loading: Array, force: float) -> int:
    """Row at which a force (k,) on the way to its largest leaves another, N, for the last time, or 0."""
    below = np.flatnonzero(loading <= force)
    return int(below[-1]) + 1 if below.size else 0


def _steady(air: Array, margin: float) -> bool:
    """Whether a force (k,) that rises by a margin, N, does so all along, and not at its end alone."""
    third = len(air) // 3
    if not third:
        return False
    first, middle, last = np.median(air[: 3 * third].reshape(3, third), axis=1)
    return bool(middle - first > STEADY * margin and last - middle < STRAIGHT * (middle - first))


def required_depth(depth: Array, force: Array) -> float:
    """Depth in m that a force curve must reach to cover a trial with `depth` (n,) m and `force` (n,) N.

    At least a micrometre, also for a trial without motion.
    """
    return max(float(depth.max()) - contact_range(depth, force).low, LEAST_TRAVEL)


def find_start(trial: TrialData, allowed: ContactRange) -> Start:
    """Best stiffness factor and force at rest by linear least squares over 41 onsets, all within the range."""
    onsets = np.linspace(allowed.low, allowed.high, ONSETS)
    shapes = np.stack([shape_above_rest(trial, allowed, onset) for onset in onsets])
    mean, force = shapes.mean(axis=1), trial.force
    power = np.einsum("ij,ij->i", shapes, shapes) - trial.rows * mean**2
    free = _ratio(shapes @ force - trial.rows * mean * force.mean(), power)
    rest = np.clip(force.mean() - free * mean, allowed.rest_low, allowed.rest_high)
    stiffness = _ratio(shapes @ force - trial.rows * mean * rest, power + trial.rows * mean**2)
    residual = force - rest[:, None] - stiffness[:, None] * shapes
    misfit = np.einsum("ij,ij->i", residual, residual)
    best = int(np.argmin(np.where(stiffness > 0.0, misfit, np.inf)))
    evidence = max(evidence_of(shapes[best], force), evidence_of_rise(trial.depth, force))
    return Start(float(stiffness[best]), float(rest[best]), float(onsets[best]), evidence)


def shape_above_rest(trial: TrialData, allowed: ContactRange, onset: float) -> Array:
    """Force (n,) in N of the curve at the trial's depths, less that at the reference depth."""
    return trial.curve(trial.depth - onset) - trial.curve(np.array([allowed.reference - onset]))


def _ratio(above: Array, below: Array) -> Array:
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0.0)


def evidence_of(shape: Array, force: Array) -> float:
    """Return t of the slope of force (n,) over shape (n,) with AR(1) noise (Cochrane and Orcutt, JASA 44:32).

    0 where the shape or the force does not vary, infinite where it explains the force without a residual.
    """
    if np.ptp(shape) == 0.0 or np.ptp(force) == 0.0:
        return 0.0
    columns = np.column_stack((shape, np.ones_like(shape), force))
    fitted, *_ = np.linalg.lstsq(columns[:, :2], force)
    white = whitened(columns, lag_one(force - columns[:, :2] @ fitted, parameters=2))
    design, target = white[:, :2], white[:, 2]
    slope, *_ = np.linalg.lstsq(design, target)
    residual = target - design @ slope
    variance = float(residual @ residual) / (len(target) - 2) * np.linalg.pinv(design.T @ design)[0, 0]
    if variance <= 0.0:
        return float(np.sign(slope[0]) * np.inf) if slope[0] else 0.0
    return float(slope[0] / np.sqrt(variance))


def evidence_of_rise(depth: Array, force: Array) -> float:
    """Return how many times the force (n,) N rises above its own noise from the shallowest to the deepest (n,) m.

    No law is assumed. The noise is what a random walk with the record's sample-to-sample noise would gain over its
    length, or the scatter of the force where the trial is least deep, which shows a drift. 0 where it does not rise.
    """
    calm = without_spikes(force)
    shallow, deep = _shallowest(depth), depth >= np.quantile(depth, 1.0 - END_ROWS)
    rise = float(np.median(calm[deep]) - np.median(calm[shallow]))
    steps = np.abs(np.diff(force))
    count = float(steps[steps > 0.0].min(initial=np.inf))
    if rise <= 0.0 or np.isinf(count):
        return 0.0
    walk = np.sqrt(3.0 * force.size) * max(sample_noise(force), count / np.sqrt(12.0))
    return float(rise / max(walk, np.std(calm[shallow])))


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
    still = _still(trial, trial.depth, STILL * travel(trial.depth))
    holds = [_hold(trial, rows, level) for rows in still if _loaded(trial.force[rows], level, rise)]
    return max(holds, key=lambda hold: hold.decay_percent, default=None)


STEADY = 0.04
"""Force within this fraction of the rise counts as held: several standard deviations of a usual sensor's noise."""
STEADIER = 3.0
"""Under a held force the depth grows by this many times more, relatively, than the force: in an elastic press, whose
force grows with the depth at least in proportion, it never does."""
SLOWING = 0.7
"""In the second half of a creep the depth grows by less than this fraction of what it does in the first: a saturated
sensor shows a force that is held, too, while the tool goes on as before."""


def largest_creep(trial: TrialData) -> float:
    """By how much of itself, in %, the depth grows while a force is held, slowing down; 0 where it does not."""
    force, depth = without_spikes(trial.force), trial.depth
    level = float(np.median(force[depth <= np.quantile(depth, 0.05)]))
    rise = float(force.max()) - level
    still = _still(trial, force, STEADY * rise) if rise > 0.0 else ()
    return max(
        (_growth(force[rows] - level, depth[rows]) for rows in still if _loaded(force[rows], level, rise)), default=0.0
    )


def _growth(force: Array, depth: Array) -> float:
    """From where a force (n,) N is first as large as it is held, of the depth (n,) m there, in %."""
    first = int(np.argmax(force >= np.median(force)))
    force, depth = force[first:], depth[first:]
    few = max(1, len(depth) // 10)
    begun, ended, middle = depth[0], float(depth[-few:].mean()), depth[len(depth) // 2]
    if len(depth) < 5 or begun <= 0.0 or ended - middle >= SLOWING * (middle - begun):
        return 0.0
    grown = 100.0 * (ended - begun) / begun
    pushed = 100.0 * abs(float(force[-few:].mean()) / float(force[:few].mean()) - 1.0)
    noise = NOISES * sample_noise(depth) / begun
    return float(grown) if grown > max(SEEN, STEADIER * pushed, 100.0 * noise) else 0.0


def _still(trial: TrialData, values: Array, tolerance: float) -> Iterator[slice]:
    """Rows of each stretch in which values (n,) stay put, in order."""
    shortest = LEAST_SHARE * float(trial.time[-1] - trial.time[0])
    first = 0
    while first < trial.rows - 4:
        moved = np.abs(values[first:] - values[first]) > tolerance
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
