"""Lin's concordance correlation: how close the pairs lie to the line of equality."""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.result import Result, Row
from benchmark.comparison.samples import Array, is_constant, paired_samples


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
        return [
            ("concordance", None, None, self.coefficient),
            ("concordance ci95 low", None, None, self.ci95_low),
            ("concordance ci95 high", None, None, self.ci95_high),
            ("correlation", None, None, self.correlation),
            ("bias correction", None, None, self.bias_correction),
        ]


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
