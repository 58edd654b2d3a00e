"""Normal distributions fitted to the deformations of two models (the paper's Fig. 13), goodness, overlap."""

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike

from benchmark.comparison.result import Result
from benchmark.comparison.samples import Array, is_constant, single_sample


@dataclass(frozen=True)
class NormalFit(Result):
    """A normal with the sample's mean and standard deviation (n - 1), and how well it fits.

    `anderson_darling` and `p_value` test normality with both parameters estimated (small p: not normal); NaN
    for a constant sample. The deformations of a load triangle are near uniform, not normal: p says so.
    """

    mean: float
    std: float
    n: int
    anderson_darling: float
    p_value: float
    note: str = ""


def normal_fit(values: ArrayLike) -> NormalFit:
    """Fit a normal to `values` (n,), any unit; Anderson-Darling with estimated parameters by statsmodels.

    Raises
    ------
    ComparisonError
        Not one-dimensional, infinite values, fewer than three values.
    """
    sample = single_sample(values, least=3)
    mean, std = float(np.mean(sample)), float(np.std(sample, ddof=1))
    if is_constant(sample):
        return NormalFit(mean, 0.0, len(sample), np.nan, np.nan, "a constant sample: no distribution to test")
    statistic, p_value = _anderson_darling(sample)
    return NormalFit(mean, std, len(sample), statistic, p_value)


def _anderson_darling(sample: Array) -> tuple[float, float]:
    from statsmodels.stats.diagnostic import normal_ad

    with np.errstate(divide="ignore"):  # a far outlier has a tail probability of zero: an infinite statistic, p = 0
        statistic, p_value = normal_ad(sample)
    return float(statistic), float(p_value)


def overlap(first: NormalFit, second: NormalFit) -> float:
    """Overlap coefficient of two fitted normals: 1 where they are the same, 0 where they share nothing.

    A constant sample is a point mass: 1 with an equal point mass, else 0. The overlap judges the two curves
    only: samples over the same load history overlap widely even where every step differs.
    """
    if first.std == 0.0 or second.std == 0.0:
        return float(first.std == second.std and first.mean == second.mean)
    return NormalDist(first.mean, first.std).overlap(NormalDist(second.mean, second.std))
