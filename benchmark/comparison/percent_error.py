"""Percent error of the wave model against the FEM, step by step and over a profile."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchmark.comparison.samples import Array, ComparisonError, Result, Row, aligned, shared_rows

UNLOADED = 1e-9
"""A FEM value below this fraction of its own largest magnitude counts as unloaded: no percentage there."""


def plain_percent(value: float, digits: int = 2, *, sign: bool = False) -> str:
    """A percentage in so many significant digits, always without a power of ten: -200 is "-200 %", not "-2e+02 %"."""
    plain = np.format_float_positional(value, digits, unique=False, fractional=False, trim="-", sign=sign)
    return f"{plain} %"


@dataclass(frozen=True)
class PercentError(Result):
    """Signed error of each step and its summary.

    Attributes
    ----------
    signed : (n,) array
        100 (wave - fem) / fem in %, NaN where the FEM is unloaded or a value is missing.
    mean : float
        Mean of the absolute value, in %; NaN without a single loaded step.
    maximum : float
        Largest absolute value, in %.
    at_peak : float
        Signed error of the step at which |fem| is largest, in %.
    steps : int
        Number of steps that have a percentage.
    """

    signed: Array
    mean: float
    maximum: float
    at_peak: float
    steps: int

    def rows(self) -> list[Row]:
        """Lines for the statistics table, in %."""
        return shared_rows(
            {
                "mean absolute %": self.mean,
                "max absolute %": self.maximum,
                "at peak %": self.at_peak,
                "steps": float(self.steps),
            }
        )


def percent_error(fem: ArrayLike, wave: ArrayLike, load: ArrayLike | None = None) -> PercentError:
    """Percent error of `wave` (n,) against `fem` (n,), in any one unit.

    A step has no percentage where `load` (n,), if given, is zero, where |fem| <= 1e-9 of its largest value,
    or where a value is missing.

    Raises
    ------
    ComparisonError
        Shapes that differ, infinite values.
    """
    reference, values = aligned(fem, wave)
    loaded = _loaded(reference, load) & ~np.isnan(values)
    signed = np.full(reference.shape, np.nan)
    signed[loaded] = 100.0 * (values[loaded] - reference[loaded]) / reference[loaded]
    if not loaded.any():
        return PercentError(signed, np.nan, np.nan, np.nan, 0)
    absolute = np.abs(signed[loaded])
    peak = int(np.nanargmax(np.abs(reference)))
    return PercentError(signed, float(absolute.mean()), float(absolute.max()), float(signed[peak]), int(loaded.sum()))


def _loaded(reference: Array, load: ArrayLike | None) -> NDArray[np.bool_]:
    known = ~np.isnan(reference)
    largest = float(np.max(np.abs(reference[known]))) if known.any() else 0.0
    loaded: NDArray[np.bool_] = known & (np.abs(reference) > UNLOADED * largest)
    if load is None:
        return loaded
    force = np.asarray(load, dtype=float)
    if force.shape != reference.shape:
        raise ComparisonError(f"load has shape {force.shape}, fem {reference.shape}: they must be the same")
    pressed: NDArray[np.bool_] = loaded & (force != 0.0)
    return pressed


@dataclass(frozen=True)
class ProfileError(Result):
    """Largest and root-mean-square |wave - fem| in % of max |fem|; `index` points at the largest."""

    maximum_percent: float
    rms_percent: float
    index: int
    points: int


def profile_error(fem: ArrayLike, wave: ArrayLike) -> ProfileError:
    """Error of the profile `wave` (m,) against `fem` (m,) at the same radii, in one unit.

    Points where either is NaN (outside the wave's window) are left out; the peak is that of the whole FEM
    profile.

    Raises
    ------
    ComparisonError
        Shapes that differ, infinite values, no common point, a FEM profile that is zero throughout.
    """
    reference, values = aligned(fem, wave)
    difference = np.abs(values - reference)
    common = ~np.isnan(difference)
    if not common.any():
        raise ComparisonError("the two profiles have no common point")
    peak = float(np.nanmax(np.abs(reference)))
    if peak == 0.0:
        raise ComparisonError("the FEM profile is zero throughout: there is no peak to relate to")
    percent = 100.0 * difference / peak
    rms = float(np.sqrt(np.mean(percent[common] ** 2)))
    return ProfileError(float(percent[common].max()), rms, int(np.nanargmax(percent)), int(common.sum()))
