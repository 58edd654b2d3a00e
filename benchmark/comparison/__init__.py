"""Measures of how far a fast model is from the FEM: pure functions on arrays, a kind of measure a file.

Nothing here runs a model, reads or writes a file. SciPy's statistics and statsmodels are loaded when a
measure first needs them.
"""

from benchmark.comparison.agreement import BlandAltman, Concordance, bland_altman, concordance
from benchmark.comparison.distributions import AreaMetric, NormalFit, area_metric, normal_fit, overlap
from benchmark.comparison.equivalence import (
    Equivalence,
    HistoryEquivalence,
    history_equivalence,
    paired_equivalence,
    two_sample_equivalence,
)
from benchmark.comparison.layer_comparison import (
    LayerComparison,
    PairStatistics,
    compare_layer,
    compare_samples,
    comparison_summary,
    describe_equivalence,
    describe_t_test,
    normal_fit_columns,
    statistics_columns,
)
from benchmark.comparison.percent_error import PercentError, ProfileError, percent_error, plain_percent, profile_error
from benchmark.comparison.samples import ComparisonError, Moments
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
from benchmark.comparison.uncertainty import (
    GridConvergence,
    Validation,
    grid_convergence,
    input_uncertainty,
    replicate_uncertainty,
)

__all__ = [
    "AreaMetric",
    "BlandAltman",
    "ComparisonError",
    "Concordance",
    "Equivalence",
    "GridConvergence",
    "HistoryEquivalence",
    "LayerComparison",
    "Moments",
    "NormalFit",
    "PairStatistics",
    "PairedT",
    "PassingRange",
    "PercentError",
    "ProfileError",
    "TwoSampleT",
    "Validation",
    "area_metric",
    "bland_altman",
    "compare_layer",
    "compare_samples",
    "comparison_summary",
    "concordance",
    "describe_equivalence",
    "describe_t_test",
    "grid_convergence",
    "history_equivalence",
    "input_uncertainty",
    "normal_fit",
    "normal_fit_columns",
    "overlap",
    "paired_equivalence",
    "paired_t_test",
    "passing_scale_errors",
    "percent_error",
    "plain_percent",
    "pooled_t_test",
    "profile_error",
    "replicate_uncertainty",
    "statistics_columns",
    "t_test_power",
    "two_sample_equivalence",
    "welch_t_test",
]
