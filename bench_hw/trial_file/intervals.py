"""What time stamps say: the usual interval of a channel, its jitter, and which intervals are gaps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

GAP_PERIODS = 1.5
"""An interval longer than this many periods is a gap in the frames of a camera."""
SHORTEST_GAP = 0.05
"""No interval shorter than this (s) is called a gap in force or depth: it is how old force data may be."""


def usual_interval(time: FloatArray) -> float:
    """Give the median interval of time stamps of shape (n,), s; NaN for fewer than two."""
    return float(np.median(np.diff(time))) if len(time) > 1 else float("nan")


def longest_allowed(time: FloatArray, shortest_gap: float = SHORTEST_GAP) -> float:
    """Give the interval (s) above which two neighbours of a channel are not neighbours any more."""
    return max(GAP_PERIODS * usual_interval(time), shortest_gap) if len(time) > 1 else shortest_gap
