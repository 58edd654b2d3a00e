"""What every measure takes and gives: samples without gaps, one error, and results as plain values and table rows.

No measure lives here; each takes its samples through these functions, so that all drop the same rows.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray


class ComparisonError(ValueError):
    """Two samples cannot be compared; the message names which, the value found and what is allowed."""


Row: TypeAlias = tuple[str, float | None, float | None, float | None]
"""One line of a statistics table: quantity, value of the FEM, value of the wave model, value of both."""


@dataclass(frozen=True)
class Result:
    """Base of the frozen result dataclasses."""

    def to_dict(self) -> dict[str, Any]:
        """Fields as plain Python values, NaN and infinities as None, arrays as lists."""
        return {field.name: plain(getattr(self, field.name)) for field in fields(self)}

    def rows(self) -> list[Row]:
        """Lines of the statistics table, in print order; empty where a result has none."""
        return []


def shared_rows(values: Mapping[str, float | None]) -> list[Row]:
    """Lines of values that belong to both models."""
    return [(quantity, None, None, value) for quantity, value in values.items()]


def plain(value: Any) -> Any:
    """Give a value as JSON knows it: NumPy scalars unwrapped, non-finite numbers None, results as dicts."""
    if isinstance(value, Result):
        return value.to_dict()
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


Array: TypeAlias = NDArray[np.float64]

ROUNDING = 1e-13
"""Spread below this fraction of the largest magnitude is rounding: the sample counts as constant."""


@dataclass(frozen=True)
class Moments(Result):
    """Mean, variance (divisor n - 1) and number of observations of one sample."""

    mean: float
    variance: float
    observations: int


def moments(sample: Array) -> Moments:
    """Moments of a sample (n,), n >= 2."""
    return Moments(float(np.mean(sample)), float(np.var(sample, ddof=1)), len(sample))


def aligned(fem: ArrayLike, wave: ArrayLike) -> tuple[Array, Array]:
    """Both samples as float arrays (n,), gaps (NaN) kept.

    Raises
    ------
    ComparisonError
        Not one-dimensional, different lengths, or an infinite value.
    """
    first, second = np.asarray(fem, dtype=float), np.asarray(wave, dtype=float)
    if first.ndim != 1 or first.shape != second.shape:
        raise ComparisonError(
            f"fem has shape {first.shape}, wave {second.shape}: both must have one dimension and one length"
        )
    for name, sample in (("fem", first), ("wave", second)):
        if np.isinf(sample).any():
            raise ComparisonError(f"{name}[{int(np.argmax(np.isinf(sample)))}] is infinite: values must be finite")
    return first, second


def paired_samples(fem: ArrayLike, wave: ArrayLike, least: int = 2) -> tuple[Array, Array]:
    """Rows in which both samples have a value, as (m,) and (m,).

    Raises
    ------
    ComparisonError
        As `aligned`, or fewer than `least` common rows.
    """
    first, second = aligned(fem, wave)
    both = ~(np.isnan(first) | np.isnan(second))
    if int(both.sum()) < least:
        raise ComparisonError(f"{int(both.sum())} common rows of {len(first)}: at least {least} are needed")
    return first[both], second[both]


def single_sample(values: ArrayLike, least: int = 2) -> Array:
    """Values (n,) without gaps.

    Raises
    ------
    ComparisonError
        Not one-dimensional, infinite, or fewer than `least` values.
    """
    sample, _ = paired_samples(values, values, least)
    return sample


def is_constant(sample: Array, magnitude: float | None = None) -> bool:
    """Whether a sample (n,) has no spread beyond rounding of `magnitude` (the largest |value| by default)."""
    scale = float(np.max(np.abs(sample))) if magnitude is None else magnitude
    return float(np.ptp(sample)) <= ROUNDING * scale
