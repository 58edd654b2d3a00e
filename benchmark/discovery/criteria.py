"""Choices of a discovery: one set for all sessions."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """What a user may choose.

    Attributes
    ----------
    rows : int
        About how many rows a trial is reduced to.
    level : float
        Family-wise level of the test for a disagreement.
    accept_z : float
        Held-out gain over its standard error from which an effect is accepted.
    most_effects : int
    lookalike_z : float
        Candidates within this many standard errors of the best count as look-alikes.
    flips : int
        Sign flips of whole trials where there are too many to take all.
    bootstraps : int
        Resamples of trials for the interval of the gap.
    tolerance : float
        Share of a channel's largest signal below which a disagreement does not matter in practice.
    workers : int
        Processes for the candidates; 1 works in this one.
    seed : int
    """

    rows: int = 220
    level: float = 0.05
    accept_z: float = 3.0
    most_effects: int = 3
    lookalike_z: float = 2.0
    flips: int = 10_000
    bootstraps: int = 400
    tolerance: float = 0.02
    workers: int = 2
    seed: int = 0
