"""Relaxation of the force: one Prony term over an elastic force history (quasi-linear viscoelasticity, Fung 1993)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from benchmark.fitting.curve import Array

LEAST_GRID = 400
"""Points of the even grid on which a history is relaxed, at least."""


@dataclass(frozen=True)
class Relaxation:
    """A force under a depth that is held falls by the share g, with the time tau (s)."""

    share: float
    tau: float


NONE = Relaxation(0.0, 1.0)


def relaxed(time: Array, elastic: Array, relaxation: Relaxation) -> Array:
    """Force (n,) N of a history of the elastic force: F - g (F - int e^(-(t - s) / tau) dF).

    Exact for a force that is linear between the points of an even grid as fine as the mean step.

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
    grid = np.linspace(time[0], time[-1], max(len(time), LEAST_GRID))
    even = np.interp(grid, time, elastic)
    keep = np.exp(-(grid[1] - grid[0]) / relaxation.tau)
    rises = np.diff(even, prepend=even[0])
    gain = relaxation.tau / (grid[1] - grid[0]) * (1.0 - keep)
    left = even[0] * np.exp(-(grid - grid[0]) / relaxation.tau)
    remembered = scipy.signal.lfilter([gain], [1.0, -keep], rises) + left
    return np.asarray(elastic - relaxation.share * (elastic - np.interp(time, grid, remembered)))
