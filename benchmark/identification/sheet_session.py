"""A session of filmed trials: each fitted by itself, pooled with the trial as the unit, held out one by one."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmark.identification.pooling import mean_interval
from benchmark.identification.sheet_model import (
    NONE,
    FilmedTrial,
    Relaxation,
    SheetState,
    sheet_force,
    sheet_markers,
)
from benchmark.identification.sheet_trial import SheetTrial, fit_sheet_trial, rms_distance
from benchmark.identification.trial_fit import TrialFit
from benchmark.response.ramp_table import RampTable

Key = tuple[str, str]


@dataclass(frozen=True)
class Pooled:
    """Mean over trials with its 95 % interval (infinite for a single trial); `trials` is how many."""

    value: float
    low: float
    high: float
    trials: int

    def exp(self) -> Pooled:
        """The same of the logarithm's argument; an end beyond all numbers is infinite: the data do not bound it."""
        with np.errstate(over="ignore"):
            value, low, high = np.exp([self.value, self.low, self.high]).tolist()
        return Pooled(value, low, high, self.trials)


@dataclass(frozen=True)
class HeldOutTrial:
    """How the other trials predict one, with its own contact, zero and axis.

    Attributes
    ----------
    force_percent : float
        Root mean square of the force residual in % of the peak.
    marker_mm : float
        Root mean square distance of predicted and seen markers, mm.
    """

    name: str
    condition: str
    force_percent: float
    marker_mm: float


@dataclass(frozen=True)
class SheetFit:
    """Stiffness, relaxation and thickness of a sheet from force and markers together.

    Attributes
    ----------
    stiffness : Pooled
        Factor on the file's modulus, at the file's thickness; at once after a step of depth.
    share, tau : Pooled or None
        Relaxation (share, s), None where no trial holds its depth.
    thickness : Pooled
        Factor on the file's thickness when it is fitted with the stiffness.
    stiffness_with_thickness : Pooled
        The stiffness factor of that fit.
    trials, with_thickness : tuple of SheetTrial
    held_out : tuple of HeldOutTrial
        Empty for a single trial.
    """

    stiffness: Pooled
    share: Pooled | None
    tau: Pooled | None
    thickness: Pooled
    stiffness_with_thickness: Pooled
    trials: tuple[SheetTrial, ...]
    with_thickness: tuple[SheetTrial, ...]
    held_out: tuple[HeldOutTrial, ...]

    @property
    def relaxation(self) -> Relaxation:
        """The pooled relaxation; none where its share cannot be told from nothing."""
        return _used(self.share, self.tau)

    def trial(self, key: Key) -> SheetTrial | None:
        """The fit of one trial by condition and name; None where it was not filmed."""
        return next((each for each in self.trials if (each.condition, each.name) == key), None)

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`."""
        return {
            "stiffness_factor": vars_of(self.stiffness),
            "relaxation_share": None if self.share is None else vars_of(self.share),
            "relaxation_time_s": None if self.tau is None else vars_of(self.tau),
            "thickness_factor": vars_of(self.thickness),
            "stiffness_factor_with_thickness_free": vars_of(self.stiffness_with_thickness),
            "trials": [_trial_entry(trial) for trial in self.trials],
            "held_out": [vars(each).copy() for each in self.held_out],
        }


def vars_of(pooled: Pooled) -> dict[str, Any]:
    """Value, interval and number of trials by name."""
    return {"value": pooled.value, "ci95": [pooled.low, pooled.high], "trials": pooled.trials}


def _trial_entry(trial: SheetTrial) -> dict[str, Any]:
    return {
        "name": trial.name,
        "condition": trial.condition,
        "stiffness_factor": math.exp(trial.state.log_stiffness),
        "onset_mm": 1e3 * trial.state.onset,
        "zero_N": trial.state.zero,
        "axis_mm": [1e3 * each for each in trial.state.axis],
        "force_rms_N": trial.force_rms,
        "marker_rms_mm": 1e3 * trial.marker_rms,
        "correlations": dict(trial.correlations),
    }


def fit_sheet(filmed: Sequence[tuple[FilmedTrial, RampTable]], starts: Mapping[Key, TrialFit]) -> SheetFit:
    """Fit filmed trials, at least one.

    The relaxation comes from the trials that hold their depth, and stays put in the fit of all trials.

    Parameters
    ----------
    filmed : sequence of (FilmedTrial, RampTable)
    starts : mapping
        Fit of the force alone by condition and name.
    """
    holding = [(film, sheet) for film, sheet in filmed if _holds(starts[film.trial.key])]
    timed = [fit_sheet_trial(film, sheet, starts[film.trial.key], ("share", "log_tau")) for film, sheet in holding]
    share, tau = _relaxation(timed)
    relaxation = _used(share, tau)
    trials = tuple(fit_sheet_trial(film, sheet, starts[film.trial.key], (), relaxation) for film, sheet in filmed)
    thick = tuple(
        fit_sheet_trial(film, sheet, starts[film.trial.key], ("log_thickness",), relaxation, known)
        for (film, sheet), known in zip(filmed, trials, strict=True)
    )
    return SheetFit(
        pooled_over(trials, "log_stiffness").exp(),
        share,
        tau,
        pooled_over(thick, "log_thickness").exp(),
        pooled_over(thick, "log_stiffness").exp(),
        trials,
        thick,
        tuple(_held_out(film, sheet, trials, relaxation) for film, sheet in filmed) if len(trials) > 1 else (),
    )


def _holds(start: TrialFit) -> bool:
    return start.hold is not None


def _used(share: Pooled | None, tau: Pooled | None) -> Relaxation:
    return NONE if share is None or tau is None or share.low <= 0.0 else Relaxation(share.value, tau.value)


def _relaxation(timed: Sequence[SheetTrial]) -> tuple[Pooled | None, Pooled | None]:
    """Share and time over the trials that hold their depth."""
    if not timed:
        return None, None
    shares = [each.state.relaxation.share for each in timed]
    times = [math.log(each.state.relaxation.tau) for each in timed]
    errors = [(each.stderr.get("share", np.inf), each.stderr.get("log_tau", np.inf)) for each in timed]
    return pool_values(shares, errors[0][0]), pool_values(times, errors[0][1]).exp()


def pooled_over(trials: Sequence[SheetTrial], name: str) -> Pooled:
    """Pool one parameter of the trials' states; a single trial has 1.96 of its own standard error."""
    return pool_values([getattr(each.state, name) for each in trials], trials[0].stderr.get(name, math.inf))


def pool_values(values: Sequence[float], stderr: float) -> Pooled:
    """Mean and 95 % t interval of one value a trial; of a single trial, 1.96 of its own standard errors."""
    if len(values) == 1:
        return Pooled(values[0], values[0] - 1.96 * stderr, values[0] + 1.96 * stderr, 1)
    mean, half, _ = mean_interval(values)
    return Pooled(mean, mean - half, mean + half, len(values))


def held_out_state(own: SheetTrial, trials: Sequence[SheetTrial], relaxation: Relaxation) -> SheetState:
    """The state of a trial with the stiffness of all others."""
    others = [each.state.log_stiffness for each in trials if each is not own]
    return replace(own.state, log_stiffness=float(np.mean(others)), relaxation=relaxation)


def _held_out(
    film: FilmedTrial, sheet: RampTable, trials: Sequence[SheetTrial], relaxation: Relaxation
) -> HeldOutTrial:
    own = next(each for each in trials if (each.condition, each.name) == film.trial.key)
    state = held_out_state(own, trials, relaxation)
    force = sheet_force(film, sheet, state) - film.trial.force
    peak = float(film.trial.force.max())
    marker = rms_distance(sheet_markers(film, sheet, state) - film.places)
    return HeldOutTrial(own.name, own.condition, 100.0 * float(np.sqrt(np.mean(force**2))) / peak, 1e3 * marker)
