"""Trials beside both models: each trial's measured depth goes in, force comes out."""

from __future__ import annotations

from dataclasses import dataclass

from benchmark.files import Session
from benchmark.identification import SessionFit, SheetFit
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
