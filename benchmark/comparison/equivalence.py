"""Equivalence of two models by two one-sided t-tests (TOST) with a stated margin.

This is the test of agreement of independent samples: equivalence within the margin is claimed only where both one-sided
tests reject, which is where the 90 % interval of the difference lies inside the margin (Schuirmann 1987).

The steps of a load history are no samples: written with more rows, the same two curves have a smaller p. Of two models
driven through one history the test stands beside the verdict: their difference, which has no scatter, is within the
margin, or it is not.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.samples import Array, ComparisonError, Result, Row, is_constant, paired_samples, shared_rows
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
        return shared_rows(
            {
                "margin": self.margin,
                "margin % of fem mean": 100.0 * self.margin_fraction,
                "mean difference": self.difference,
                "difference ci90 low": self.ci90_low,
                "difference ci90 high": self.ci90_high,
                "p lower": self.p_low,
                "p upper": self.p_high,
                "p": self.p_value,
                "equivalent": float(self.equivalent),
            }
        )


@dataclass(frozen=True, kw_only=True)
class HistoryEquivalence(Equivalence):
    """The paired test over the steps of one load history, beside the verdict, which it does not decide.

    Attributes
    ----------
    over_load : float
        Mean difference over that of the FEM's size, each over what the FEM goes through, straight from step to step and
        from nought to the first: rows on a line, or in a hold, change nothing.
    worst : float
        Largest difference of any step over the FEM's largest value.
    """

    over_load: float
    worst: float

    @property
    def on_average(self) -> bool:
        """Whether the mean difference is inside the margin."""
        return abs(self.over_load) < self.margin_fraction

    @property
    def within_margin(self) -> bool:
        """Whether it is, and the difference of every step is, of the largest value: with any number of rows alike."""
        return self.on_average and abs(self.worst) < self.margin_fraction

    def rows(self) -> list[Row]:
        """Lines for the statistics table; `p` and `equivalent` take the steps for independent samples."""
        history = {
            "difference over the load %": 100.0 * self.over_load,
            "largest difference %": 100.0 * self.worst,
            "within margin": float(self.within_margin),
        }
        return [*super().rows(), *shared_rows(history)]


def history_equivalence(fem: ArrayLike, wave: ArrayLike, margin_fraction: float = 0.02) -> HistoryEquivalence:
    """Equivalence of two models over the steps (n,) of one load history; parameters and errors as the paired form."""
    test = paired_equivalence(fem, wave, margin_fraction)
    first, second = paired_samples(fem, wave)
    delta, size = np.append(0.0, second - first), np.append(0.0, np.abs(first))
    way = np.append(0.0, np.cumsum(np.abs(np.diff(first, prepend=0.0))))
    over_load = float(np.trapezoid(delta, way) / np.trapezoid(size, way))
    worst = float(delta[np.abs(delta).argmax()] / size.max())
    return HistoryEquivalence(**vars(test), over_load=over_load, worst=worst)


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
    delta, df = second - first, len(first) - 1.0
    if is_constant(delta, float(max(np.abs(first).max(), np.abs(second).max()))):
        return _outcome("paired", margin_fraction, margin, delta, df, note=ALL_EQUAL)
    _, low, high = ttost_paired(second, first, -margin, margin)
    error = float(np.std(delta, ddof=1)) / np.sqrt(len(delta))
    return _outcome("paired", margin_fraction, margin, delta, df, error, (low[:2], high[:2]))


def two_sample_equivalence(fem: ArrayLike, wave: ArrayLike, margin_fraction: float = 0.02) -> Equivalence:
    """TOST of the difference of two independent means; parameters and errors as the paired form.

    One pooled variance. The spread of the load history is its noise: over a triangle of 100 steps it cannot
    show equivalence within 2 % even of two equal samples. The paired form can.
    """
    from statsmodels.stats.weightstats import ttost_ind

    first, second = paired_samples(fem, wave)
    margin = _margin(first, margin_fraction)
    delta, df = second - first, 2.0 * len(first) - 2.0
    if is_constant(first) and is_constant(second):
        return _outcome("two_sample", margin_fraction, margin, delta, df, note=NO_VARIANCE)
    _, low, high = ttost_ind(second, first, -margin, margin, usevar="pooled")
    error = float(np.sqrt((np.var(first, ddof=1) + np.var(second, ddof=1)) / len(first)))
    return _outcome("two_sample", margin_fraction, margin, delta, df, error, (low[:2], high[:2]))


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
    df: float,
    error: float = 0.0,
    tests: tuple[tuple[float, float], tuple[float, float]] | None = None,
    note: str = "",
) -> Equivalence:
    """From the standard error and both one-sided tests (t, p each); without tests the difference is certain."""
    difference = float(delta.mean())
    half = float(scipy.stats.t.ppf(1.0 - LEVEL, df)) * error
    certain = ((np.nan, float(difference <= -margin)), (np.nan, float(difference >= margin)))
    (t_low, p_low), (t_high, p_high) = ((float(t), float(p)) for t, p in tests or certain)
    return Equivalence(
        form=form,
        margin_fraction=fraction,
        margin=margin,
        difference=difference,
        ci90_low=difference - half,
        ci90_high=difference + half,
        t_low=t_low,
        p_low=p_low,
        t_high=t_high,
        p_high=p_high,
        df=df,
        p_value=max(p_low, p_high),
        note=note,
    )
