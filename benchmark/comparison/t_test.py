"""Two-sample t-tests between the deformations of two models, in the form of the paper's Table 2.

A test that does not reject is no evidence of agreement: `power` says what such a test lets pass and
`equivalence` is the test of agreement.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.result import Result, Row
from benchmark.comparison.samples import Array, Moments, is_constant, moments, paired_samples

NO_VARIANCE = "both samples are constant: t is not defined"


@dataclass(frozen=True)
class TwoSampleT(Result):
    """A two-sample t-test of equal means.

    Attributes
    ----------
    form : str
        `pooled` (one variance, df = 2n - 2) or `welch` (two variances, Satterthwaite's df).
    fem, wave : Moments
        Mean, variance (n - 1) and observations.
    hypothesized_difference : float
        Difference of the means under the null hypothesis.
    df, t, p_value, t_critical : float
        p is two-tailed, t_critical the two-tailed 5 % value; NaN for t and p where both samples are constant.
    difference, ci95_low, ci95_high : float
        Mean of wave minus mean of FEM and its 95 % interval.
    note : str
        What could not be computed and why, or empty.
    """

    form: str
    fem: Moments
    wave: Moments
    hypothesized_difference: float
    df: float
    t: float
    p_value: float
    t_critical: float
    difference: float
    ci95_low: float
    ci95_high: float
    note: str = ""

    @property
    def rejects(self) -> bool:
        """Whether equal means are rejected at 5 %; False says nothing about agreement."""
        return bool(self.p_value < 0.05)

    def rows(self) -> list[Row]:
        """Lines of Table 2, in its order, with the degrees of freedom."""
        return [
            ("mean", self.fem.mean, self.wave.mean, None),
            ("variance", self.fem.variance, self.wave.variance, None),
            ("observations", self.fem.observations, self.wave.observations, None),
            ("hypothesized mean difference", None, None, self.hypothesized_difference),
            ("df", None, None, self.df),
            ("t", None, None, self.t),
            ("p two-tail", None, None, self.p_value),
            ("t critical", None, None, self.t_critical),
        ]


def pooled_t_test(fem: ArrayLike, wave: ArrayLike, hypothesized_difference: float = 0.0) -> TwoSampleT:
    """Student's two-sample t-test with one pooled variance: t = (mean(fem) - mean(wave) - h) / se.

    Parameters
    ----------
    fem, wave : (n,)
        Deformations in one unit; rows with a gap in either are left out of both.
    hypothesized_difference : float
        h, in the same unit.

    Raises
    ------
    ComparisonError
        Shapes that differ, infinite values, fewer than two common rows.
    """
    return _two_sample(fem, wave, hypothesized_difference, pooled=True)


def welch_t_test(fem: ArrayLike, wave: ArrayLike, hypothesized_difference: float = 0.0) -> TwoSampleT:
    """Welch's two-sample t-test with two variances; parameters and errors as `pooled_t_test`."""
    return _two_sample(fem, wave, hypothesized_difference, pooled=False)


def _two_sample(fem: ArrayLike, wave: ArrayLike, hypothesis: float, pooled: bool) -> TwoSampleT:
    first, second = paired_samples(fem, wave)
    form = "pooled" if pooled else "welch"
    difference = float(np.mean(second) - np.mean(first))
    if is_constant(first) and is_constant(second):
        return _constant(form, first, second, hypothesis, difference)
    test = scipy.stats.ttest_ind(first - hypothesis, second, equal_var=pooled)
    interval = test.confidence_interval(0.95)
    return TwoSampleT(
        form,
        moments(first),
        moments(second),
        hypothesis,
        float(test.df),
        float(test.statistic),
        float(test.pvalue),
        float(scipy.stats.t.ppf(0.975, test.df)),
        difference,
        -float(interval.high) - hypothesis,
        -float(interval.low) - hypothesis,
    )


def _constant(form: str, first: Array, second: Array, hypothesis: float, difference: float) -> TwoSampleT:
    df = float(len(first) + len(second) - 2)
    critical = float(scipy.stats.t.ppf(0.975, df))
    return TwoSampleT(
        form,
        moments(first),
        moments(second),
        hypothesis,
        df,
        np.nan,
        np.nan,
        critical,
        difference,
        difference,
        difference,
        NO_VARIANCE,
    )
