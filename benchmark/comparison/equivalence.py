"""Equivalence of two models by two one-sided t-tests (TOST) with a stated margin.

This is the test of agreement: equivalence within the margin is claimed only where both one-sided tests
reject, which is where the 90 % interval of the difference lies inside the margin (Schuirmann 1987).
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.samples import Array, ComparisonError, Result, Row, is_constant, paired_samples
from benchmark.comparison.t_tests import ALL_EQUAL, NO_VARIANCE

LEVEL = 0.05


@dataclass(frozen=True)
class Equivalence(Result):
    """Outcome of two one-sided tests.

    Attributes
    ----------
    form : str
        `paired` (differences of the same steps) or `two_sample` (pooled variance).
    margin_fraction : float
        Margin as a fraction of |mean of the FEM|.
    margin : float
        The same in the unit of the samples.
    difference : float
        Mean of wave minus mean of FEM.
    ci90_low, ci90_high : float
        Its 90 % interval.
    t_low, p_low, t_high, p_high, df : float
        The one-sided tests against -margin and +margin.
    p_value : float
        The larger of both.
    note : str
        What was degenerate, or empty: without variance p is 0 inside the margin and 1 outside.
    """

    form: str
    margin_fraction: float
    margin: float
    difference: float
    ci90_low: float
    ci90_high: float
    t_low: float
    p_low: float
    t_high: float
    p_high: float
    df: float
    p_value: float
    note: str = ""

    @property
    def equivalent(self) -> bool:
        """Whether the difference is shown to lie inside the margin at 5 %."""
        return bool(self.p_value < LEVEL)

    def rows(self) -> list[Row]:
        """Lines for the statistics table; `equivalent` is 1 or 0."""
        return [
            ("margin", None, None, self.margin),
            ("margin % of fem mean", None, None, 100.0 * self.margin_fraction),
            ("mean difference", None, None, self.difference),
            ("difference ci90 low", None, None, self.ci90_low),
            ("difference ci90 high", None, None, self.ci90_high),
            ("p lower", None, None, self.p_low),
            ("p upper", None, None, self.p_high),
            ("p", None, None, self.p_value),
            ("equivalent", None, None, float(self.equivalent)),
        ]


def paired_equivalence(fem: ArrayLike, wave: ArrayLike, margin_fraction: float = 0.02) -> Equivalence:
    """TOST of the paired difference of `wave` (n,) minus `fem` (n,), in one unit.

    Parameters
    ----------
    margin_fraction : float
        Margin as a fraction of |mean of the FEM|, above 0.

    Raises
    ------
    ComparisonError
        Samples that cannot be paired, a margin that is not positive, a FEM whose mean is zero.
    """
    from statsmodels.stats.weightstats import ttost_paired

    first, second = paired_samples(fem, wave)
    margin = _margin(first, margin_fraction)
    delta = second - first
    if is_constant(delta, float(max(np.abs(first).max(), np.abs(second).max()))):
        return _certain("paired", margin_fraction, margin, float(delta.mean()), len(delta) - 1.0, ALL_EQUAL)
    _, low, high = ttost_paired(second, first, -margin, margin)
    error = float(np.std(delta, ddof=1)) / np.sqrt(len(delta))
    return _outcome("paired", margin_fraction, margin, delta, error, len(delta) - 1.0, low[:2], high[:2])


def two_sample_equivalence(fem: ArrayLike, wave: ArrayLike, margin_fraction: float = 0.02) -> Equivalence:
    """TOST of the difference of two independent means; parameters and errors as the paired form.

    One pooled variance. The spread of the load history is its noise: over a triangle of 100 steps it cannot
    show equivalence within 2 % even of two equal samples. The paired form can.
    """
    from statsmodels.stats.weightstats import ttost_ind

    first, second = paired_samples(fem, wave)
    margin = _margin(first, margin_fraction)
    n, delta = len(first), second - first
    if is_constant(first) and is_constant(second):
        return _certain("two_sample", margin_fraction, margin, float(delta.mean()), 2.0 * n - 2.0, NO_VARIANCE)
    _, low, high = ttost_ind(second, first, -margin, margin, usevar="pooled")
    error = float(np.sqrt((np.var(first, ddof=1) + np.var(second, ddof=1)) / n))
    return _outcome("two_sample", margin_fraction, margin, delta, error, 2.0 * n - 2.0, low[:2], high[:2])


def _margin(fem: Array, fraction: float) -> float:
    if not (np.isfinite(fraction) and fraction > 0.0):
        raise ComparisonError(f"equivalence margin {fraction!r}: a fraction of the FEM's mean above 0 is needed")
    margin = fraction * abs(float(np.mean(fem)))
    if margin == 0.0:
        raise ComparisonError("the mean of fem is zero: a margin as a fraction of it is not defined")
    return margin


def _outcome(
    form: str,
    fraction: float,
    margin: float,
    delta: Array,
    standard_error: float,
    df: float,
    low: tuple[float, float],
    high: tuple[float, float],
) -> Equivalence:
    difference = float(delta.mean())
    half = float(scipy.stats.t.ppf(1.0 - LEVEL, df)) * standard_error
    p_low, p_high = float(low[1]), float(high[1])
    return Equivalence(
        form,
        fraction,
        margin,
        difference,
        difference - half,
        difference + half,
        float(low[0]),
        p_low,
        float(high[0]),
        p_high,
        df,
        max(p_low, p_high),
    )


def _certain(form: str, fraction: float, margin: float, difference: float, df: float, note: str) -> Equivalence:
    p_low, p_high = float(difference <= -margin), float(difference >= margin)
    return Equivalence(
        form,
        fraction,
        margin,
        difference,
        difference,
        difference,
        np.nan,
        p_low,
        np.nan,
        p_high,
        df,
        max(p_low, p_high),
        note,
    )
