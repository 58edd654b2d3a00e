"""Agreement of two models pair by pair: Bland and Altman's limits, Lin's concordance.

Bland and Altman, Lancet 327:307 (1986) and Statistical Methods in Medical Research 8:135 (1999); Lin, Biometrics 45:255
(1989).
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.samples import Array, Result, Row, is_constant, paired_samples, shared_rows

ROUNDING = 64.0 * np.finfo(np.float64).eps
"""Below it what a concordance lacks of 1 is rounding: pairs that differ by 1e-7 of their scatter or less."""


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
        return shared_rows(
            {
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
        )


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


@dataclass(frozen=True)
class Concordance(Result):
    """Lin's coefficient with its 95 % interval.

    Attributes
    ----------
    coefficient : float
        2 s12 / (s1^2 + s2^2 + (m1 - m2)^2); 1 only where every pair is equal.
    ci95_low, ci95_high : float
        By Fisher's z; NaN where it is not defined (`note` says why).
    correlation : float
        Pearson's r, the precision.
    bias_correction : float
        coefficient / r, the accuracy.
    note : str
    """

    coefficient: float
    ci95_low: float
    ci95_high: float
    correlation: float
    bias_correction: float
    note: str = ""

    def rows(self) -> list[Row]:
        """Lines for the statistics table."""
        return shared_rows(
            {
                "concordance": self.coefficient,
                "concordance ci95 low": self.ci95_low,
                "concordance ci95 high": self.ci95_high,
                "correlation": self.correlation,
                "bias correction": self.bias_correction,
            }
        )


def concordance(fem: ArrayLike, wave: ArrayLike) -> Concordance:
    """Lin's concordance correlation of `wave` (n,) with `fem` (n,), in one unit.

    Lin (Biometrics 45:255, 1989), moments with divisor n; variance of z as corrected in Biometrics 56:324
    (2000).

    Raises
    ------
    ComparisonError
        Shapes that differ, infinite values, fewer than three common rows.
    """
    first, second = paired_samples(fem, wave, least=3)
    if is_constant(first) or is_constant(second):
        return Concordance(np.nan, np.nan, np.nan, np.nan, np.nan, "a constant sample: correlation is not defined")
    r = float(np.clip(np.corrcoef(first, second)[0, 1], -1.0, 1.0))
    s1, s2 = float(np.std(first)), float(np.std(second))
    shift = float(np.mean(first) - np.mean(second))
    bias_correction = 2.0 * s1 * s2 / (s1**2 + s2**2 + shift**2)
    coefficient = r * bias_correction
    if _all_equal(first, second):
        return Concordance(1.0, 1.0, 1.0, 1.0, 1.0, "every pair is equal: the interval has no width")
    if 1.0 - coefficient <= ROUNDING:
        return Concordance(1.0, 1.0, 1.0, r, bias_correction, "pairs equal to rounding: the interval has no width")
    low, high, note = _interval(coefficient, r, shift**2 / (s1 * s2), len(first))
    return Concordance(coefficient, low, high, r, bias_correction, note)


def _all_equal(first: Array, second: Array) -> bool:
    return is_constant(np.append(second - first, 0.0), float(np.max(np.abs(first))))


def _interval(c: float, r: float, u2: float, n: int) -> tuple[float, float, str]:
    """95 % interval of Lin's coefficient c by z = atanh(c), u2 = (m1 - m2)^2 / (s1 s2)."""
    if r == 0.0:
        return np.nan, np.nan, "no correlation: the interval is not defined"
    rest = 1.0 - c**2
    variance = (
        (1.0 - r**2) * c**2 / (rest * r**2)
        + 2.0 * c**3 * (1.0 - c) * u2 / (r * rest**2)
        - c**4 * u2**2 / (2.0 * r**2 * rest**2)
    ) / max(n - 2, 1)
    if variance < 0.0:
        return np.nan, np.nan, "the asymptotic variance is negative: the interval is not defined"
    half = float(scipy.stats.norm.ppf(0.975)) * np.sqrt(variance)
    z = np.arctanh(c)
    return float(np.tanh(z - half)), float(np.tanh(z + half)), ""
