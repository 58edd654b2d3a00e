"""Arrays as figures take them: checked for shape, NaN for no value, thinned where lines are long."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def column(name: str, values: Any, length: int | None = None) -> Floats:
    """Return a one-dimensional array, NaN for None.

    Raises
    ------
    ValueError
        If it is not one-dimensional, infinite somewhere, or not `length` long.
    """
    array = np.asarray(values, dtype=np.float64)
    wanted = (array.size if length is None else length,)
    if array.shape != wanted:
        raise ValueError(f"{name} has shape {array.shape}, allowed: {wanted}")
    return _without_infinity(name, array)


def matrix(name: str, values: Any, shape: tuple[int, int]) -> Floats:
    """Return a two-dimensional array of a given shape, NaN for None; ValueError otherwise."""
    array = np.asarray(values, dtype=np.float64)
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}, allowed: {shape}")
    return _without_infinity(name, array)


def optional_column(name: str, values: Any, length: int) -> Floats | None:
    """Return `column`, or None for None and for an array without any value."""
    return None if values is None else _if_any(column(name, values, length))


def optional_matrix(name: str, values: Any, shape: tuple[int, int]) -> Floats | None:
    """Return `matrix`, or None for None and for an array without any value."""
    return None if values is None else _if_any(matrix(name, values, shape))


def layer_of(values: Floats | None, layer: int) -> Floats | None:
    """Return the column of one layer of an optional (n, L) array; None where there is no value in it."""
    return None if values is None else _if_any(values[:, layer])


def peak(values: Floats) -> float:
    """Return the largest number of an array, NaN if it holds none."""
    return float(np.nanmax(values)) if np.isfinite(values).any() else float("nan")


def last_value(values: Floats) -> int | None:
    """Return the index of the last entry that is a number; None if there is none."""
    present = np.flatnonzero(np.isfinite(values))
    return int(present[-1]) if present.size else None


def stopped_at(values: Floats) -> int | None:
    """Return the index of the last number if only NaN follows, None where the series reaches its end."""
    last = last_value(values)
    return None if last is None or last == len(values) - 1 else last


def thinned(x: Floats, y: Floats, limit: int = 240) -> tuple[Floats, Floats]:
    """Return at most about `limit` points of a line, its ends and extremes among them."""
    if len(x) <= limit:
        return x, y
    keep = set(np.linspace(0, len(x) - 1, limit - 4).round().astype(int).tolist())
    for series in (x, y):
        if np.isfinite(series).any():
            keep |= {int(np.nanargmin(series)), int(np.nanargmax(series))}
    index = np.array(sorted(keep))
    return x[index], y[index]


def shared_limits(series: Sequence[Floats], ratio: float = 5.0) -> tuple[float, float] | None:
    """Return common axis limits, zero among them, of series whose peaks are alike within a factor of `ratio`.

    None where they differ more, so that each needs a scale of its own, or where there is nothing to draw.
    """
    peaks = [float(np.nanmax(np.abs(values))) for values in series if np.isfinite(values).any()]
    if not peaks or min(peaks) == 0 or max(peaks) > ratio * min(peaks):
        return None
    numbers = np.concatenate([values[np.isfinite(values)] for values in series])
    low, high = min(float(numbers.min()), 0.0), max(float(numbers.max()), 0.0)
    room = 0.06 * (high - low)
    return (low - room if low < 0 else 0.0, high + room if high > 0 else 0.0)


def _if_any(array: Floats) -> Floats | None:
    return array if np.isfinite(array).any() else None


def _without_infinity(name: str, array: Floats) -> Floats:
    if np.isinf(array).any():
        raise ValueError(f"{name} is infinite at index {np.argwhere(np.isinf(array))[0].tolist()}")
    return array
