"""A trial whose markers were filmed, as the fit of a sheet takes it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmark.fitting.contact import contact_range
from benchmark.fitting.curve import Array
from benchmark.fitting.trial import TrialData

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
