"""Where a trial's force rises: bounds and a start for the contact onset, and whether there is contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmark.fitting.autocorrelation import lag_one, whitened
from benchmark.fitting.curve import Array
from benchmark.fitting.trial import TrialData

RISEN = 0.01
"""Force above its level at the least depth, as a fraction of its rise, at which contact has begun."""
NOISES = 6.0
"""The same in standard deviations of the force's sample-to-sample noise."""
LEAST_EVIDENCE = 5.0
"""Least t of the stiffness, with autocorrelated noise, that counts as contact."""
LEAST_TRAVEL = 1e-6
"""A trial whose depth stays within this range (m) has no motion."""
ONSETS = 41


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

    `evidence` is the t of the stiffness with autocorrelated noise.
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
    and six standard deviations of its noise, for the last time before the largest force. It began at the
    earliest as far above that as the deepest row lies below it, and no more than a tenth of the travel above
    the least depth. The force at the least depth is its median there, within twice those margins.

    Parameters
    ----------
    depth, force : (n,)
        m and N.
    """
    shallow = depth <= np.quantile(depth, 0.05)
    calm = without_spikes(force)
    level, peak = float(np.median(force[shallow])), int(np.argmax(calm))
    margin = max(NOISES * sample_noise(force), RISEN * float(calm[peak] - level))
    below = np.flatnonzero(calm[:peak] <= level + margin)
    risen = float(depth[below[-1] + 1]) if below.size else float(depth.min())
    low = max(float(depth.min()) - 0.1 * travel(depth), 2.0 * risen - float(depth.max()))
    high = max(risen, low + 1e-3 * travel(depth))
    margin = max(margin, np.finfo(float).tiny)
    return ContactRange(low, high, float(np.median(depth[shallow])), level - 2.0 * margin, level + 2.0 * margin)


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
    evidence = evidence_of(shapes[best], force)
    return Start(float(stiffness[best]), float(rest[best]), float(onsets[best]), evidence)


def shape_above_rest(trial: TrialData, allowed: ContactRange, onset: float) -> Array:
    """Force (n,) in N of the curve at the trial's depths, less that at the reference depth."""
    return trial.curve(trial.depth - onset) - trial.curve(np.array([allowed.reference - onset]))


def _ratio(above: Array, below: Array) -> Array:
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0.0)


def evidence_of(shape: Array, force: Array) -> float:
    """Return t of the slope of force (n,) over shape (n,) with AR(1) noise (Cochrane and Orcutt, JASA 44:32).

    0 where the shape does not vary, infinite where it explains the force without a residual.
    """
    if np.ptp(shape) == 0.0:
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
