"""When numbered samples that were read together were taken.

What is measured is the moment of reading. Samples that waited in the socket or in one datagram were taken
earlier, by their distance in the sequence times the period that the device reads back, or less where they
would run into the call before (that one was read late). The stamps of one stream increase strictly in the
order of arrival, so a late record stands just after those that overtook it (its sequence number tells).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

TICK = 1e-6
"""Least distance between two stamps, s."""


def back_dated(now: float, previous: float, sequence: NDArray[np.int64], period: float) -> NDArray[np.float64]:
    """Stamp samples read at `now`.

    Parameters
    ----------
    now : float
        Moment of reading, s.
    previous : float
        Stamp of the last sample of the call before (-inf if there is none), s.
    sequence : ndarray (n,)
        Unwrapped sequence numbers in order of arrival; the highest was taken at `now`.
    period : float
        Time between two samples, s.

    Returns
    -------
    ndarray (n,)
        Sampling instants, s: at least `TICK` apart and after `previous`.
    """
    if not len(sequence):
        return np.zeros(0)
    newest = sequence.max()
    spread = min(period, (now - previous) / (newest - sequence.min() + 1))
    instants = now - (newest - sequence) * spread
    ramp = TICK * np.arange(1, len(sequence) + 1)
    floored = np.maximum(instants, previous + ramp)
    stamps: NDArray[np.float64] = np.maximum.accumulate(floored - ramp) + ramp
    return stamps
