"""Paired difference of two models over the same load steps, with its 95 % interval."""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.result import Result, Row
from benchmark.comparison.samples import is_constant, paired_samples

ALL_EQUAL = "the differences do not vary: t is not defined"


@dataclass(frozen=True)
class PairedT(Result):
    """Mean of wave minus FEM over n pairs: standard deviation (n - 1), t, two-tailed p, 95 % interval."""

    difference: float
    std: float
    observations: int
    df: int
    t: float
    p_value: float
    t_critical: float
    ci95_low: float
    ci95_high: float
    note: str = ""

    def rows(self) -> list[Row]:
        """Lines for the statistics table."""
        return [
            ("mean difference", None, None, self.difference),
            ("std of difference", None, None, self.std),
            ("observations", None, None, self.observations),
            ("t", None, None, self.t),
            ("p two-tail", None, None, self.p_value),
            ("t critical", None, None, self.t_critical),
            ("difference ci95 low", None, None, self.ci95_low),
            ("difference ci95 high", None, None, self.ci95_high),
        ]


def paired_t_test(fem: ArrayLike, wave: ArrayLike) -> PairedT:
    """Student's t-test of a zero mean difference of `wave` (n,) minus `fem` (n,), in one unit.

    Load steps are no random sample: the interval describes the mean over this load history.

    Raises
    ------
    ComparisonError
        Shapes that differ, infinite values, fewer than two common rows.
    """
    first, second = paired_samples(fem, wave)
    delta = second - first
    df = len(delta) - 1
    critical = float(scipy.stats.t.ppf(0.975, df))
    mean, std = float(np.mean(delta)), float(np.std(delta, ddof=1))
    if is_constant(delta, float(max(np.abs(first).max(), np.abs(second).max()))):
        return PairedT(mean, std, df + 1, df, np.nan, np.nan, critical, mean, mean, ALL_EQUAL)
    test = scipy.stats.ttest_1samp(delta, 0.0)
    interval = test.confidence_interval(0.95)
    return PairedT(
        mean,
        std,
        df + 1,
        df,
        float(test.statistic),
        float(test.pvalue),
        critical,
        float(interval.low),
        float(interval.high),
    )
