"""What is fitted to tracks: a parabola for each marker, a circle for each frame, and the largest radius with its time.

Parabolas are those of the article's section 3.2.5. Circles (its Figs. 8 and 10) are the algebraic fit the article uses,
x^2 + y^2 + a x + b y + c = 0 by least squares; through all nine markers of a block, the middle one included, they are
5.7 % smaller than through the ring of eight.

The largest sample of a radius is too large by the noise that made it the largest, and the longer the sheet is held, the
more. A parabola over the samples around it has less noise, but cuts off a sharp peak if it reaches too far. So the
reach grows only as long as the values it gives agree within their errors (intersection of confidence intervals).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.displacement.tracks import FloatArray

_FEWEST = 4
_REACHES = (2, 3, 4, 6, 8, 11, 15, 20, 27, 36, 48)
_CONFIDENCE = 2.0
_TOO_LARGE = 3.0
"""The largest sample is too large by up to so many standard deviations."""


@dataclass(frozen=True, eq=False, slots=True)
class ParabolaFits:
    """Parabolas a t^2 + b t + c.

    Parameters
    ----------
    a, b, c : ndarray, shape (...)
        Coefficients; NaN where there were fewer than four values.
    r2 : ndarray, shape (...)
        1 less the share of the variance that is left; NaN where the values do not vary.
    count : ndarray, shape (...)
        Values that were known.
    """

    a: FloatArray
    b: FloatArray
    c: FloatArray
    r2: FloatArray
    count: FloatArray


def fit_parabolas(t: FloatArray, values: FloatArray) -> ParabolaFits:
    """Fit a parabola over time (or frame numbers, as the article does) to each column.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Instants or frame numbers.
    values : ndarray, shape (n, ...)
        For instance displacements (n, m, 2); NaN where not known.

    Returns
    -------
    ParabolaFits
        Of shape (...).
    """
    columns = values.reshape(len(values), -1)
    fits = np.array([_fit(t, column) for column in columns.T]).reshape(-1, 5)
    shape = values.shape[1:]
    a, b, c, r2, count = (fits[:, index].reshape(shape) for index in range(5))
    return ParabolaFits(a, b, c, r2, count)


def _fit(t: FloatArray, values: FloatArray) -> tuple[float, float, float, float, int]:
    known = np.isfinite(values)
    count = int(known.sum())
    if count < _FEWEST:
        return np.nan, np.nan, np.nan, np.nan, count
    t, values = t[known], values[known]
    middle, reach = float(t.mean()), float(np.ptp(t)) / 2.0 or 1.0
    s = (t - middle) / reach
    basis = np.stack([s * s, s, np.ones_like(s)], axis=1)
    (a, b, c), *_ = np.linalg.lstsq(basis, values, rcond=None)
    left = values - basis @ np.array([a, b, c])
    total = float(((values - values.mean()) ** 2).sum())
    r2 = 1.0 - float((left**2).sum()) / total if total > 0.0 else np.nan
    a, b = a / reach**2, b / reach
    return float(a), float(b - 2.0 * a * middle), float(c - b * middle + a * middle**2), r2, count


@dataclass(frozen=True, eq=False, slots=True)
class Circles:
    """Circles, one per frame.

    Parameters
    ----------
    centre : ndarray, shape (n, 2)
        In the unit of the points; NaN where one of the points is missing: the others would give another circle.
    radius : ndarray, shape (n,)
        Likewise.
    """

    centre: FloatArray
    radius: FloatArray


def fit_circles(points: FloatArray) -> Circles:
    """Fit a circle to the points of each frame.

    Parameters
    ----------
    points : ndarray, shape (n, k, 2)
        At least three points a frame, NaN where missing.
    """
    middle = points.mean(axis=1, keepdims=True)
    whole = np.isfinite(middle).all(axis=(1, 2))
    x, y = np.moveaxis(points[whole] - middle[whole], 2, 0)
    basis = np.stack([x, y, np.ones_like(x)], axis=2)
    square = x * x + y * y
    normal = np.einsum("nki,nkj->nij", basis, basis)
    solved = np.linalg.solve(normal, np.einsum("nki,nk->ni", basis, square)[:, :, None])[:, :, 0]
    offset = 0.5 * solved[:, :2]
    centre, radius = np.full((len(points), 2), np.nan), np.full(len(points), np.nan)
    centre[whole] = middle[whole, 0] + offset
    radius[whole] = np.sqrt(solved[:, 2] + (offset**2).sum(axis=1))
    return Circles(centre, radius)


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
