"""What the pooled two-sample t-test can see of a scale error, and which scale errors it lets pass.

A load history spreads the deformations between zero and the peak; that spread is the test's noise. So a wave
model that is wrong by a constant factor is let pass over a wide range, however exact both models are.
"""

import math
from dataclasses import dataclass

import scipy
from numpy.typing import ArrayLike

from benchmark.comparison.errors import ComparisonError
from benchmark.comparison.result import Result, Row
from benchmark.comparison.samples import Moments, moments, single_sample


@dataclass(frozen=True)
class PassingRange(Result):
    """Scale errors e of wave = (1 + e) fem that the pooled t-test does not reject at 5 %.

    `low` < 0 < `high` are fractions; an infinite end means that no error in that direction is ever rejected.
    """

    low: float
    high: float

    def rows(self) -> list[Row]:
        """Lines for the statistics table, in %."""
        return [
            ("scale error passed from %", None, None, 100.0 * self.low),
            ("scale error passed to %", None, None, 100.0 * self.high),
        ]


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
