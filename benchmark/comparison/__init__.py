"""Measures of how far a fast model is from the FEM: a measure a file, pure functions on arrays.

Nothing here runs a model, reads or writes a file. SciPy's statistics and statsmodels are loaded when a
measure first needs them.
"""

from benchmark.comparison.area_metric import AreaMetric, area_metric
from benchmark.comparison.bland_altman import BlandAltman, bland_altman
from benchmark.comparison.concordance import Concordance, concordance
from benchmark.comparison.equivalence import Equivalence, paired_equivalence, two_sample_equivalence
from benchmark.comparison.errors import ComparisonError
from benchmark.comparison.grid_convergence import GridConvergence, grid_convergence
from benchmark.comparison.layer import LayerComparison, PairStatistics, compare_layer
from benchmark.comparison.normal_fit import NormalFit, normal_fit, overlap
from benchmark.comparison.paired import PairedT, paired_t_test
from benchmark.comparison.percent_error import PercentError, percent_error
from benchmark.comparison.power import PassingRange, passing_scale_errors, t_test_power
from benchmark.comparison.profile_error import ProfileError, profile_error
from benchmark.comparison.samples import Moments
from benchmark.comparison.t_test import TwoSampleT, pooled_t_test, welch_t_test
from benchmark.comparison.tables import comparison_summary, normal_fit_columns, statistics_columns
from benchmark.comparison.validation import Validation, input_uncertainty, replicate_uncertainty
from benchmark.comparison.wording import describe_equivalence, describe_t_test

__all__ = [
    "AreaMetric",
    "BlandAltman",
    "ComparisonError",
    "Concordance",
    "Equivalence",
    "GridConvergence",
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
    "comparison_summary",
    "concordance",
    "describe_equivalence",
    "describe_t_test",
    "grid_convergence",
    "input_uncertainty",
    "normal_fit",
    "normal_fit_columns",
    "overlap",
    "paired_equivalence",
    "paired_t_test",
    "passing_scale_errors",
    "percent_error",
    "pooled_t_test",
    "profile_error",
    "replicate_uncertainty",
    "statistics_columns",
    "t_test_power",
    "two_sample_equivalence",
    "welch_t_test",
]
