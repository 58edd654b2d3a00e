"""t-tests between the deformations of two models, and what the pooled one can see.

The two-sample tests have the form of the paper's Table 2. One that does not reject is no evidence of agreement: a load
history spreads the deformations between zero and the peak, that spread is the test's noise, and a wave model that is
wrong by a constant factor passes over a wide range (`passing_scale_errors`, `t_test_power`). The test of agreement is
in `equivalence`.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.samples import (
    Array,
    ComparisonError,
    Moments,
    Result,
    Row,
    is_constant,
    moments,
    paired_samples,
    shared_rows,
    single_sample,
)

NO_VARIANCE = "both samples are constant: t is not defined"
LARGE_EFFECT = 0.8
"""Standard deviations that are called large (J. Cohen 1988, Statistical Power Analysis, section 2.2)."""
ALL_EQUAL = "the differences do not vary: t is not defined"


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


def group_t_test(first: ArrayLike, second: ArrayLike) -> TwoSampleT:
    """Welch's test of two independent groups, (n,) and (m,): its `fem` is the first group, its `wave` the second.

    Raises
    ------
    ComparisonError
        Infinite values, fewer than two in a group.
    """
    return _tested(single_sample(first), single_sample(second), 0.0, pooled=False)


def group_power(sizes: tuple[int, int], effect: float = LARGE_EFFECT) -> float:
    """Power at 5 % of a t-test between groups of such sizes against a difference of so many standard deviations."""
    from statsmodels.stats.power import TTestIndPower

    return float(TTestIndPower().power(effect, sizes[0], 0.05, ratio=sizes[1] / sizes[0]))


def detectable_effect(sizes: tuple[int, int], power: float = 0.8) -> float:
    """Difference in standard deviations that a t-test between groups of such sizes finds with such a power."""
    from statsmodels.stats.power import TTestIndPower

    found = TTestIndPower().solve_power(None, sizes[0], 0.05, power=power, ratio=sizes[1] / sizes[0])
    return float(np.ravel(found)[0])


def _two_sample(fem: ArrayLike, wave: ArrayLike, hypothesis: float, pooled: bool) -> TwoSampleT:
    return _tested(*paired_samples(fem, wave), hypothesis, pooled)


def _tested(first: Array, second: Array, hypothesis: float, pooled: bool) -> TwoSampleT:
    difference = float(np.mean(second) - np.mean(first))
    if is_constant(first) and is_constant(second):
        df, t, p, note = len(first) + len(second) - 2.0, np.nan, np.nan, NO_VARIANCE
        low = high = difference
    else:
        test = scipy.stats.ttest_ind(first - hypothesis, second, equal_var=pooled)
        interval = test.confidence_interval(0.95)
        df, t, p, note = float(test.df), float(test.statistic), float(test.pvalue), ""
        low, high = -float(interval.high) - hypothesis, -float(interval.low) - hypothesis
    return TwoSampleT(
        form="pooled" if pooled else "welch",
        fem=moments(first),
        wave=moments(second),
        hypothesized_difference=hypothesis,
        df=df,
        t=t,
        p_value=p,
        t_critical=float(scipy.stats.t.ppf(0.975, df)),
        difference=difference,
        ci95_low=low,
        ci95_high=high,
        note=note,
    )


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
        return shared_rows(
            {
                "mean difference": self.difference,
                "std of difference": self.std,
                "observations": self.observations,
                "t": self.t,
                "p two-tail": self.p_value,
                "t critical": self.t_critical,
                "difference ci95 low": self.ci95_low,
                "difference ci95 high": self.ci95_high,
            }
        )


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


@dataclass(frozen=True)
class PassingRange(Result):
    """Scale errors e of wave = (1 + e) fem that the pooled t-test does not reject at 5 %.

    `low` < 0 < `high` are fractions; an infinite end means that no error in that direction is ever rejected.
    """

    low: float
    high: float

    def rows(self) -> list[Row]:
        """Lines for the statistics table, in %."""
        return shared_rows(
            {
                "scale error passed from %": 100.0 * self.low,
                "scale error passed to %": 100.0 * self.high,
            }
        )


def passing_scale_errors(fem: ArrayLike) -> PassingRange:
    """Range of scale errors that the pooled t-test passes for the deformations `fem` (n,), any unit.

    With m, v the mean and variance (n - 1) of the FEM, t^2 = n m^2 e^2 / (v (1 + (1 + e)^2)) is set to the
    square of the two-tailed 5 % value for 2n - 2 degrees of freedom, which is a quadratic in e.

    Raises
    ------
    ComparisonError
        Fewer than two values, infinite values, or a constant zero sample.
    """
    sample = _nonzero(fem)
    critical = float(scipy.stats.t.ppf(0.975, 2 * sample.observations - 2))
    noise = critical**2 * sample.variance
    lead = sample.observations * sample.mean**2 - noise
    if noise == 0.0:
        return PassingRange(0.0, 0.0)
    if noise + 2.0 * lead <= 0.0:
        return PassingRange(-math.inf, math.inf)
    root = math.sqrt(noise**2 + 2.0 * noise * lead)
    return PassingRange(-2.0 * noise / (noise + root), (noise + root) / lead if lead > 0.0 else math.inf)


def t_test_power(fem: ArrayLike, scale_error: float) -> float:
    """Power of the pooled t-test at 5 % against wave = (1 + scale_error) fem, by the non-central t.

    Both samples are taken as random draws with the moments of `fem` (n,) and of its scaled copy.

    Raises
    ------
    ComparisonError
        As `passing_scale_errors`.
    """
    from statsmodels.stats.power import TTestIndPower

    sample = _nonzero(fem)
    spread = math.sqrt(0.5 * sample.variance * (1.0 + (1.0 + scale_error) ** 2))
    if spread == 0.0:
        return 1.0 if scale_error != 0.0 else 0.05
    effect = abs(scale_error * sample.mean) / spread
    return float(TTestIndPower().power(effect, sample.observations, 0.05, ratio=1.0))


def _nonzero(fem: ArrayLike) -> Moments:
    sample = moments(single_sample(fem))
    if sample.mean == 0.0 and sample.variance == 0.0:
        raise ComparisonError("fem is zero throughout: a scale error changes nothing in it")
    return sample
