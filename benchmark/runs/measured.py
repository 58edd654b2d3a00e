"""Trials beside both models: each trial's measured depth goes in, force comes out."""

from __future__ import annotations

from dataclasses import dataclass

from benchmark.files import Session
from benchmark.fitting import SessionFit
from benchmark.models import Array


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
class MeasuredComparison:
    """A session, its fit, and every trial beside the models."""

    session: Session
    fit: SessionFit
    trials: tuple[TrialPrediction, ...]
