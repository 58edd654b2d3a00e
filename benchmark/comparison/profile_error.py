"""Difference of two deflection profiles over radius, in percent of the FEM's peak."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from benchmark.comparison.errors import ComparisonError
from benchmark.comparison.result import Result
from benchmark.comparison.samples import aligned


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
