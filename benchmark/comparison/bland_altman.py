"""Bland and Altman's bias and limits of agreement, with intervals.

Lancet 327:307 (1986); Statistical Methods in Medical Research 8:135 (1999).
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.result import Result, Row
from benchmark.comparison.samples import Array, paired_samples


@dataclass(frozen=True)
class BlandAltman(Result):
    """Bias of wave minus FEM and the limits that hold 95 % of the differences, each with a 95 % interval.

    Attributes
    ----------
    mean, difference : (m,) arrays
        Abscissa (fem + wave) / 2 and ordinate wave - fem of the plot, in the unit of the samples.
    bias, std : float
        Mean and standard deviation (n - 1) of the differences.
    lower, upper : float
        bias -+ 1.96 std.
    bias_ci95, lower_ci95, upper_ci95 : (low, high)
    """

    mean: Array
    difference: Array
    bias: float
    std: float
    lower: float
    upper: float
    bias_ci95: tuple[float, float]
    lower_ci95: tuple[float, float]
    upper_ci95: tuple[float, float]

    def rows(self) -> list[Row]:
        """Lines for the statistics table."""
        named = {
            "bias": self.bias,
            "std of difference": self.std,
            "lower limit": self.lower,
            "upper limit": self.upper,
            "bias ci95 low": self.bias_ci95[0],
            "bias ci95 high": self.bias_ci95[1],
            "lower limit ci95 low": self.lower_ci95[0],
            "lower limit ci95 high": self.lower_ci95[1],
            "upper limit ci95 low": self.upper_ci95[0],
            "upper limit ci95 high": self.upper_ci95[1],
        }
        return [(quantity, None, None, value) for quantity, value in named.items()]


def bland_altman(fem: ArrayLike, wave: ArrayLike) -> BlandAltman:
    """Bias, limits and intervals of `wave` (n,) minus `fem` (n,), in one unit.

    The standard error of a limit is std sqrt(1/n + z^2 / (2 (n - 1))), z = 1.96 (Bland and Altman 1999);
    intervals use Student's t with n - 1 degrees of freedom.

    Raises
    ------
    ComparisonError
        Shapes that differ, infinite values, fewer than two common rows.
    """
    first, second = paired_samples(fem, wave)
    delta = second - first
    n = len(delta)
    z = float(scipy.stats.norm.ppf(0.975))
    t = float(scipy.stats.t.ppf(0.975, n - 1))
    bias, std = float(delta.mean()), float(np.std(delta, ddof=1))
    of_bias = t * std / np.sqrt(n)
    of_limit = t * std * np.sqrt(1.0 / n + z**2 / (2.0 * (n - 1)))
    return BlandAltman(
        0.5 * (first + second),
        delta,
        bias,
        std,
        bias - z * std,
        bias + z * std,
        _around(bias, of_bias),
        _around(bias - z * std, of_limit),
        _around(bias + z * std, of_limit),
    )


def _around(centre: float, half: float) -> tuple[float, float]:
    return float(centre - half), float(centre + half)
