"""Trials beside both models: each trial's measured depth goes in, force comes out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmark.files import Session
from benchmark.identification import SessionFit, SheetFit
from benchmark.identification.trial_features import sample_noise
from benchmark.models import Array
from benchmark.runs.trials.film_tables import MarkerMotion
from benchmark.runs.trials.filming import Tracked


@dataclass(frozen=True)
class TrialPrediction:
    """One trial and what both models make of its depth.

    Attributes
    ----------
    trial, condition
        Its name and condition.
    time, depth, force
        (n,) s, m, N as measured.
    fem_force, wave_force
        (n,) N with the session's pooled stiffness and the trial's own contact onset and zero; the wave's is None where
        it does not cover the specimen.
    held_out_force
        (n,) N of the FEM with the stiffness pooled over the other trials; None with a single trial.
    """

    trial: str
    condition: str
    time: Array
    depth: Array
    force: Array
    fem_force: Array
    wave_force: Array | None
    held_out_force: Array | None


@dataclass(frozen=True)
class FilmedSession:
    """The markers of a session: their motion, what was tracked in this run, and the fit with them (None without)."""

    motions: tuple[MarkerMotion, ...]
    tracked: tuple[Tracked, ...]
    sheet: SheetFit | None


@dataclass(frozen=True)
class MeasuredComparison:
    """A session, its fit, and every trial beside the models.

    Attributes
    ----------
    session, fit, trials
        As read, fitted and predicted.
    filmed
        What the markers tell; None without any.
    """

    session: Session
    fit: SessionFit
    trials: tuple[TrialPrediction, ...]
    filmed: FilmedSession | None = None


LEAST_AT_PEAK = 5
"""Rows at a peak from which it is fitted; of fewer, which rise by more than the noise, the largest is taken."""
LOWEST = 3.0
"""Standard deviations of the noise by which rows at the peak may lie below it."""
MOST_APEXES = 100


def peak_weights(time: Array, force: Array) -> Array:
    """(n,) weights, of sum one, by which a record tells its peak, and those of a model's force at the same rows.

    The largest of n rows lies some sqrt(2 ln n) standard deviations of the noise above the force of a hold. So rows in
    one run that are no lower than that and three more below the largest are at the peak: their mean, or the apex of two
    lines that meet in it (in `time` (n,), s) where the Bayesian information criterion finds those worth their three
    parameters. Without noise this is the largest row. A model that is right has no error then but the noise: 0.02
    standard deviations of it in a hold, 0.15 in a triangle, where the largest row has 2.8 and 1.1.

    Parameters
    ----------
    time, force : (n,) array
        s and N of the record, not of the model.
    """
    weights, at = np.zeros(force.size), int(force.argmax())
    noise = sample_noise(force) if force.size > 2 else 0.0
    low = np.flatnonzero(force < force[at] - (LOWEST + np.sqrt(2.0 * np.log(force.size))) * noise)
    first, last = int(low[low < at].max(initial=-1)) + 1, int(low[low > at].min(initial=force.size))
    if noise == 0.0 or last - first < LEAST_AT_PEAK:
        weights[at] = 1.0
    else:
        weights[first:last] = _weights_of_apex(time[first:last], force[first:last])
    return weights


def _weights_of_apex(time: Array, force: Array) -> Array:
    """(m,) weights of the mean, or of the apex of the two lines that fit best."""
    rows, best = force.size, np.full(force.size, 1.0 / force.size)
    least = float(((force - force.mean()) ** 2).sum()) * np.exp(-3.0 * np.log(rows) / rows)
    for apex in time[np.unique(np.linspace(0, rows - 1, MOST_APEXES).astype(int))]:
        lines = np.column_stack([np.ones(rows), np.minimum(time - apex, 0.0), np.maximum(time - apex, 0.0)])
        solution = np.linalg.pinv(lines)
        left = float(((force - lines @ (solution @ force)) ** 2).sum())
        if left < least:
            least, best = left, solution[0]
    return best


def peak_force(time: Array, force: Array) -> float:
    """The peak of a record (n,), N; see `peak_weights`."""
    return float(peak_weights(time, force) @ force)
