"""All measures of one layer, FEM and wave model side by side: as a result, as table columns, in words.

A t-test that does not reject is never called agreement.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from benchmark.comparison.agreement import BlandAltman, Concordance, bland_altman, concordance
from benchmark.comparison.distributions import AreaMetric, NormalFit, area_metric, normal_fit, overlap
from benchmark.comparison.equivalence import Equivalence, HistoryEquivalence, history_equivalence
from benchmark.comparison.percent_error import PercentError, percent_error, plain_percent
from benchmark.comparison.samples import Result, Row, aligned, plain
from benchmark.comparison.t_tests import (
    PairedT,
    PassingRange,
    TwoSampleT,
    paired_t_test,
    passing_scale_errors,
    pooled_t_test,
    t_test_power,
    welch_t_test,
)

LEAST_STEPS = 3
UNCOVERED = "fewer than three steps that both models reached: nothing to compare"
STATISTICS = ("layer", "test", "quantity", "fem", "wave", "value")
NORMAL_FITS = ("layer", "model", "mean_mm", "std_mm", "n", "anderson_darling", "p_value")


@dataclass(frozen=True)
class PairStatistics(Result):
    """The tests between two models on the steps that both reached.

    `power` is that of the pooled t-test against a scale error as large as the equivalence margin.
    """

    pooled: TwoSampleT
    welch: TwoSampleT
    paired: PairedT
    equivalence: HistoryEquivalence
    bland_altman: BlandAltman
    concordance: Concordance
    passing: PassingRange
    power: float
    overlap: float
    area: AreaMetric


@dataclass(frozen=True)
class LayerComparison(Result):
    """One layer, deformations in mm; or another quantity in its own unit.

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
            "within_margin": found.equivalence.within_margin if found else None,
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
        Equivalence margin as a fraction of the FEM's mean, and in each step of its largest value.

    Raises
    ------
    ComparisonError
        Shapes that differ, infinite values, a margin that is not positive, a FEM whose mean is zero.
    """
    first, second = (1e3 * sample for sample in aligned(fem, wave))
    return compare_samples(layer, first, second, load, margin_fraction)


def compare_samples(
    name: str, fem: ArrayLike, wave: ArrayLike, load: ArrayLike | None = None, margin_fraction: float = 0.02
) -> LayerComparison:
    """Compare `wave` (n,) with `fem` (n,), which may be anything that both have at n load steps, in its own unit.

    Parameters and errors are those of `compare_layer`.
    """
    first, second = aligned(fem, wave)
    percent = percent_error(first, second, load)
    fits = [normal_fit(s) if np.count_nonzero(~np.isnan(s)) >= LEAST_STEPS else None for s in (first, second)]
    both = ~np.isnan(first) & ~np.isnan(second)
    if int(both.sum()) < LEAST_STEPS:
        return LayerComparison(name, percent, fits[0], fits[1], None, UNCOVERED)
    statistics = PairStatistics(
        pooled_t_test(first, second),
        welch_t_test(first, second),
        paired_t_test(first, second),
        history_equivalence(first, second, margin_fraction),
        bland_altman(first, second),
        concordance(first, second),
        passing_scale_errors(first[both]),
        t_test_power(first[both], margin_fraction),
        overlap(normal_fit(first[both]), normal_fit(second[both])),
        area_metric(first[both], second[both]),
    )
    return LayerComparison(name, percent, fits[0], fits[1], statistics)


def statistics_columns(layers: Sequence[LayerComparison]) -> dict[str, list[Any]]:
    """Columns of `statistics.csv`; deformations in mm, variances in mm^2, None where a cell is empty."""
    lines = [(layer.layer, test, *row) for layer in layers for test, rows in layer.tests().items() for row in rows]
    return _columns(STATISTICS, lines)


def normal_fit_columns(
    layers: Sequence[LayerComparison], models: tuple[str, str] = ("fem", "wave")
) -> dict[str, list[Any]]:
    """Columns of `normal_fits.csv`, one line per layer and model; a model without values has no line.

    `models` are the names of the two in the column `model`.
    """
    lines = [
        (layer.layer, model, fit.mean, fit.std, fit.n, fit.anderson_darling, fit.p_value)
        for layer in layers
        for model, fit in zip(models, (layer.fem_fit, layer.wave_fit), strict=True)
        if fit is not None
    ]
    return _columns(NORMAL_FITS, lines)


def comparison_summary(layers: Sequence[LayerComparison]) -> dict[str, dict[str, Any]]:
    """`comparison` of results.json: one entry per layer."""
    return {layer.layer: layer.summary() for layer in layers}


def _columns(names: Sequence[str], lines: Sequence[Sequence[Any]]) -> dict[str, list[Any]]:
    return {name: [plain(line[column]) for line in lines] for column, name in enumerate(names)}


def describe_t_test(test: TwoSampleT, passing: PassingRange, power: float | None = None) -> str:
    """One paragraph on the pooled t-test, with the scale errors it lets pass and its `power` at the margin."""
    if math.isnan(test.p_value):
        return f"The two-sample t-test has no outcome: {test.note}."
    reach = f"It lets pass any scale error from {_percent(passing.low)} to {_percent(passing.high)}."
    if power is not None:
        reach += f" Its power to see a scale error as large as the equivalence margin is {100.0 * power:.3g} %."
    numbers = f"t = {test.t:.4g}, df = {test.df:.4g}, p = {test.p_value:.4g}, t critical = {test.t_critical:.6f}"
    if test.rejects:
        return f"The two-sample t-test rejects the hypothesis of one common mean ({numbers}). {reach}"
    return f"The two-sample t-test does not reject, which shows nothing either way ({numbers}). {reach}"


def describe_equivalence(test: Equivalence) -> str:
    """One paragraph on the equivalence test, with its margin and, over a load history, what decides instead."""
    margin = f"{100.0 * test.margin_fraction:.3g} % of the FEM's mean"
    found = f"p = {test.p_value:.3g}, 90 % interval of the difference {_share(test)}"
    same = test.within_margin if isinstance(test, HistoryEquivalence) else test.equivalent
    verdict = f"Equivalent within {margin}" if same else f"Equivalence within {margin} is not shown"
    form = test.form.replace("_", "-")
    if not isinstance(test, HistoryEquivalence):
        return f"{verdict} (TOST, {form}: {found})."
    over_load, worst = (plain_percent(100.0 * share, 3, sign=True) for share in (test.over_load, test.worst))
    return (
        f"{verdict}: over the load the difference is {over_load} of it, and at most "
        f"{worst} of the largest value. The two one-sided tests (TOST, {form}) take the steps for "
        f"independent samples, so that their outcome depends on the number of rows ({found})."
    )


def _share(test: Equivalence) -> str:
    scale = 100.0 * test.margin_fraction / test.margin
    low, high = (plain_percent(scale * end, 3, sign=True) for end in (test.ci90_low, test.ci90_high))
    return f"{low.removesuffix(' %')} to {high} of it"


def _percent(fraction: float) -> str:
    return "any size" if math.isinf(fraction) else f"{100.0 * fraction:+.1f} %"
