"""A filmed trial of a sheet over a hole, and what the model says of it: force with relaxation, and markers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmark.identification.trial_data import TrialData
from benchmark.identification.trial_features import contact_range
from benchmark.response.force_curve import Array
from benchmark.response.ramp_table import RampTable
from benchmark.response.setup_change import THICKNESS
from wavemodel.integrators.scan import decaying_sum

LEAST_REST = 3
"""Frames with the tool in the air that a rest position is averaged over; else as many from the start."""


@dataclass(frozen=True)
class Film:
    """Markers over the frames of one trial.

    Attributes
    ----------
    time : (f,) array
        s, increasing, on the trial's clock.
    places : (f, m, 2) array
        As the camera sees them, m; NaN where a marker was not seen.
    """

    time: Array
    places: Array


@dataclass(frozen=True)
class FilmedTrial:
    """A trial with the frames that its depth is known for.

    Attributes
    ----------
    trial : TrialData
    depth : (f,) array
        Of the actuator at the frames, m.
    places : (f, m, 2) array
        m; only markers that were seen at rest.
    rest : (m, 2) array
        m.
    """

    trial: TrialData
    depth: Array
    places: Array
    rest: Array


def filmed_trial(trial: TrialData, film: Film) -> FilmedTrial | None:
    """Put a film beside its trial; None where too few frames lie within the trial's time."""
    inside = (film.time >= trial.time[0]) & (film.time <= trial.time[-1])
    if int(inside.sum()) < 2 * LEAST_REST:
        return None
    places = film.places[inside]
    depth = np.interp(film.time[inside], trial.time, trial.depth)
    resting = np.flatnonzero(depth <= contact_range(trial.depth, trial.force).low)
    resting = resting if len(resting) >= LEAST_REST else np.arange(LEAST_REST)
    seen = np.isfinite(places[resting]).all(axis=2).any(axis=0)
    if not seen.any():
        return None
    rest = np.nanmean(places[resting][:, seen], axis=0)
    return FilmedTrial(trial, depth, places[:, seen], np.asarray(rest))


@dataclass(frozen=True)
class Relaxation:
    """A force under a depth that is held falls by the share g, with the time tau (s)."""

    share: float
    tau: float


NONE = Relaxation(0.0, 1.0)


def relaxed(time: Array, elastic: Array, relaxation: Relaxation) -> Array:
    """Force (n,) N of a history of the elastic force: F - g (F - int e^(-(t - s) / tau) dF).

    Exact for an elastic force that is linear between the rows.

    Parameters
    ----------
    time : (n,) array
        s, increasing.
    elastic : (n,) array
        N, at once after a step of depth; before the first row it was as in it.
    relaxation : Relaxation
    """
    if relaxation.share == 0.0:
        return elastic
    passed = np.diff(time, prepend=time[0]) / relaxation.tau
    part = np.divide(-np.expm1(-passed), passed, out=np.ones_like(passed), where=passed > 0.0)
    remembered = decaying_sum(passed, part * np.diff(elastic, prepend=elastic[0]), elastic[0])
    return np.asarray(elastic - relaxation.share * (elastic - remembered))


@dataclass(frozen=True)
class SheetState:
    """Parameters of one trial; SI, thickness as the logarithm of its ratio to the file's."""

    log_stiffness: float
    onset: float
    zero: float
    axis: tuple[float, float] = (0.0, 0.0)
    log_thickness: float = 0.0
    relaxation: Relaxation = NONE

    @property
    def changes(self) -> Mapping[str, float]:
        """Of the set-up, by its keys."""
        return {THICKNESS: self.log_thickness}


def sheet_force(filmed: FilmedTrial, sheet: RampTable, state: SheetState) -> Array:
    """Force (n,) N of each row of a trial."""
    trial = filmed.trial
    elastic = math.exp(state.log_stiffness) * sheet.force(trial.depth - state.onset, state.changes)
    pressing = np.maximum(relaxed(trial.time, elastic, state.relaxation), 0.0)
    return np.asarray(state.zero + np.where(trial.depth > state.onset, pressing, 0.0))


def sheet_markers(filmed: FilmedTrial, sheet: RampTable, state: SheetState) -> Array:
    """Where the camera sees each marker, (f, m, 2) m."""
    below = filmed.depth - state.onset
    return sheet.markers(filmed.rest, np.array(state.axis), below, state.changes)
