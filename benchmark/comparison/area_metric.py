"""Area validation metric: the area between two empirical distribution functions.

Ferson, Oberkampf and Ginzburg, Comput. Methods Appl. Mech. Eng. 197:2408 (2008); Roy and Oberkampf, Comput. Methods
Appl. Mech. Eng. 200:2131 (2011), eq. 15. Split into the part where the model lies above and the part where it lies
below the reference: Voyles and Roy, AIAA 2014-0809.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.result import Result, Row
from benchmark.comparison.samples import single_sample


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
        return [
            ("area", None, None, self.area),
            ("area above", None, None, self.above),
            ("area below", None, None, self.below),
        ]


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
