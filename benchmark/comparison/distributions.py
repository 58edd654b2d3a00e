"""The distributions of two models' deformations: fitted normals (the paper's Fig. 13), and the area between them.

Area validation metric: Ferson, Oberkampf and Ginzburg, Comput. Methods Appl. Mech. Eng. 197:2408 (2008); Roy and
Oberkampf, Comput. Methods Appl. Mech. Eng. 200:2131 (2011), eq. 15. Split into the part where the model lies above and
the part where it lies below the reference: Voyles and Roy, AIAA 2014-0809.
"""

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.samples import Array, Result, Row, is_constant, shared_rows, single_sample


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


@dataclass(frozen=True)
class AreaMetric(Result):
    """Area between the distributions of a model and of its reference, in the unit of the samples.

    Attributes
    ----------
    area : float
        Integral of |F_model - F_reference|: 0 only where both distributions are the same. It does not see which value
        belongs to which step or trial.
    above, below : float
        Its parts where the model's values are larger, and smaller, than the reference's.
    """

    area: float
    above: float
    below: float

    def rows(self) -> list[Row]:
        """Lines for the statistics table."""
        return shared_rows(
            {
                "area": self.area,
                "area above": self.above,
                "area below": self.below,
            }
        )


def area_metric(reference: ArrayLike, model: ArrayLike) -> AreaMetric:
    """Area metric of `model` (m,) against `reference` (n,), in one unit; both lose their gaps (NaN).

    Raises
    ------
    ComparisonError
        Not one-dimensional, infinite values, or no value.
    """
    first, second = np.sort(single_sample(reference, least=1)), np.sort(single_sample(model, least=1))
    area = float(scipy.stats.wasserstein_distance(first, second))
    grid = np.sort(np.concatenate((first, second)))
    lower = np.searchsorted(first, grid[:-1], side="right") / first.size
    upper = np.searchsorted(second, grid[:-1], side="right") / second.size
    above = float(np.sum(np.diff(grid) * np.maximum(lower - upper, 0.0)))
    return AreaMetric(area, above, float(np.sum(np.diff(grid) * np.maximum(upper - lower, 0.0))))
