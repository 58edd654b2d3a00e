"""All measures of one layer: the deformations of FEM and wave model over the load steps, side by side."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from benchmark.comparison.area_metric import AreaMetric, area_metric
from benchmark.comparison.bland_altman import BlandAltman, bland_altman
from benchmark.comparison.concordance import Concordance, concordance
from benchmark.comparison.equivalence import Equivalence, paired_equivalence
from benchmark.comparison.normal_fit import NormalFit, normal_fit, overlap
from benchmark.comparison.paired import PairedT, paired_t_test
from benchmark.comparison.percent_error import PercentError, percent_error
from benchmark.comparison.power import PassingRange, passing_scale_errors, t_test_power
from benchmark.comparison.result import Result, Row, plain
from benchmark.comparison.samples import aligned
from benchmark.comparison.t_test import TwoSampleT, pooled_t_test, welch_t_test

LEAST_STEPS = 3
UNCOVERED = "fewer than three steps that both models reached: nothing to compare"


@dataclass(frozen=True)
class PairStatistics(Result):
    """The tests between two models on the steps that both reached.

    `power` is that of the pooled t-test against a scale error as large as the equivalence margin.
    """

    pooled: TwoSampleT
    welch: TwoSampleT
    paired: PairedT
    equivalence: Equivalence
    bland_altman: BlandAltman
    concordance: Concordance
    passing: PassingRange
    power: float
    overlap: float
    area: AreaMetric


@dataclass(frozen=True)
class LayerComparison(Result):
    """One layer, deformations in mm.

    Attributes
    ----------
    layer : str
    percent : PercentError
    fem_fit, wave_fit : NormalFit or None
        None where a model has fewer than three values.
    statistics : PairStatistics or None
        None where fewer than three steps are common (`note` says so).
    note : str
    """

    layer: str
    percent: PercentError
    fem_fit: NormalFit | None
    wave_fit: NormalFit | None
    statistics: PairStatistics | None
    note: str = ""

    def tests(self) -> dict[str, list[Row]]:
        """Lines of `statistics.csv` by test; empty without statistics."""
        if self.statistics is None:
            return {}
        found = self.statistics
        return {
            "t_pooled": found.pooled.rows(),
            "t_pooled_power": [*found.passing.rows(), ("power at the margin", None, None, found.power)],
            "t_welch": found.welch.rows(),
            "paired": found.paired.rows(),
            "tost": found.equivalence.rows(),
            "bland_altman": found.bland_altman.rows(),
            "concordance": found.concordance.rows(),
            "percent_error": self.percent.rows(),
            "normal_overlap": [("overlap", None, None, found.overlap)],
            "area_metric": found.area.rows(),
        }

    def summary(self) -> dict[str, Any]:
        """`comparison.LAYER` of results.json; None where a value does not exist."""
        found = self.statistics
        return {
            "percent_error_mean": plain(self.percent.mean),
            "percent_error_max": plain(self.percent.maximum),
            "t_statistic": plain(found.pooled.t) if found else None,
            "p_value": plain(found.pooled.p_value) if found else None,
            "t_critical": plain(found.pooled.t_critical) if found else None,
            "tost_p": plain(found.equivalence.p_value) if found else None,
            "equivalent": found.equivalence.equivalent if found else None,
        }


def compare_layer(
    layer: str, fem: ArrayLike, wave: ArrayLike, load: ArrayLike | None = None, margin_fraction: float = 0.02
) -> LayerComparison:
    """Compare the deflections `wave` (n,) with `fem` (n,) of one layer over n load steps, both in metres.

    Parameters
    ----------
    layer : str
        Name of the layer.
    fem, wave : (n,)
        Deflection of the layer's top face on the tool axis, m, press positive; NaN where there is none.
    load : (n,), optional
        Load of each step; no percentage where it is zero.
    margin_fraction : float
        Equivalence margin as a fraction of the FEM's mean.

    Raises
    ------
    ComparisonError
        Shapes that differ, infinite values, a margin that is not positive, a FEM whose mean is zero.
    """
    first, second = (1e3 * sample for sample in aligned(fem, wave))
    percent = percent_error(first, second, load)
    fits = [normal_fit(s) if np.count_nonzero(~np.isnan(s)) >= LEAST_STEPS else None for s in (first, second)]
    both = ~np.isnan(first) & ~np.isnan(second)
    if int(both.sum()) < LEAST_STEPS:
        return LayerComparison(layer, percent, fits[0], fits[1], None, UNCOVERED)
    statistics = PairStatistics(
        pooled_t_test(first, second),
        welch_t_test(first, second),
        paired_t_test(first, second),
        paired_equivalence(first, second, margin_fraction),
        bland_altman(first, second),
        concordance(first, second),
        passing_scale_errors(first[both]),
        t_test_power(first[both], margin_fraction),
        overlap(normal_fit(first[both]), normal_fit(second[both])),
        area_metric(first[both], second[both]),
    )
    return LayerComparison(layer, percent, fits[0], fits[1], statistics)
