"""The largest radius and its time.

The largest sample is too large by the noise that made it the largest, and the longer the sheet is held, the more. A
parabola over the samples around it has less noise, but cuts off a sharp peak if it reaches too far. So the reach
grows only as long as the values it gives agree within their errors (the intersection of confidence intervals).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.displacement.tracks import FloatArray

_REACHES = (2, 3, 4, 6, 8, 11, 15, 20, 27, 36, 48)
_CONFIDENCE = 2.0
_TOO_LARGE = 3.0
"""The largest sample is too large by up to so many standard deviations."""


@dataclass(frozen=True, slots=True)
class MaximumRadius:
    """A largest radius.

    Parameters
    ----------
    time : float
        s.
    radius : float
        In the unit of the samples.
    std : float
        Standard deviation of `radius`; NaN where it is a mere sample.
    frame : int
        The nearest frame.
    """

    time: float
    radius: float
    std: float
    frame: int


def largest_sample(time: FloatArray, radius: FloatArray) -> MaximumRadius:
    """Give the largest sample, as the article takes it.

    Raises
    ------
    InputError
        No radius is known.
    """
    if not np.isfinite(radius).any():
        raise InputError("no frame has a circle: the markers it goes through were never all seen at once")
    frame = int(np.nanargmax(radius))
    return MaximumRadius(float(time[frame]), float(radius[frame]), float("nan"), frame)


def maximum_radius(time: FloatArray, radius: FloatArray, noise: float | None = None) -> MaximumRadius:
    """Estimate the largest radius from the samples around it.

    Parameters
    ----------
    time : ndarray, shape (n,)
        s.
    radius : ndarray, shape (n,)
        NaN where not known.
    noise : float, optional
        Standard deviation of a sample; from the samples' third differences without it.

    Raises
    ------
    InputError
        No radius is known.
    """
    best = largest_sample(time, radius)
    noise = sample_noise(radius) if noise is None else noise
    low, high = best.radius - _TOO_LARGE * noise, best.radius + noise
    for reach in _REACHES:
        found = _peak(time, radius, best.frame, reach, noise)
        if found is None:
            continue
        low, high = max(low, found.radius - _CONFIDENCE * found.std), min(high, found.radius + _CONFIDENCE * found.std)
        if low > high:
            break
        best = found
    return best


def sample_noise(radius: FloatArray) -> float:
    """Give the standard deviation of a sample from the third differences, which a smooth motion does not survive."""
    third = np.diff(radius, 3)
    third = third[np.isfinite(third)]
    return float(1.4826 * np.median(np.abs(third)) / np.sqrt(20.0)) if len(third) else 0.0


def _peak(time: FloatArray, radius: FloatArray, frame: int, reach: int, noise: float) -> MaximumRadius | None:
    """The highest point of a parabola over the frames up to `reach` from one; None with too few of them."""
    rows = np.arange(max(frame - reach, 0), min(frame + reach + 1, len(radius)))
    rows = rows[np.isfinite(radius[rows])]
    if len(rows) < 4:
        return None
    half = float(np.ptp(time[rows])) / 2.0
    s = (time[rows] - time[frame]) / half
    basis = np.stack([np.ones_like(s), s, s * s], axis=1)
    inverse = np.linalg.pinv(basis)
    _, b, a = inverse @ radius[rows]
    at = float(np.clip(-b / (2.0 * a), s[0], s[-1])) if a < 0.0 else float(s[0] if b < 0.0 else s[-1])
    weights = np.array([1.0, at, at * at]) @ inverse
    found = float(time[frame] + at * half)
    return MaximumRadius(
        found,
        float(weights @ radius[rows]),
        noise * float(np.hypot.reduce(weights)),
        int(np.argmin(np.abs(time - found))),
    )
