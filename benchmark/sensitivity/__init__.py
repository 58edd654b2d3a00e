"""Which parameter matters to which result: Sobol indices with confidence intervals, by SALib."""

from benchmark.sensitivity.design import DEFAULT_BASE, LEAST_BASE, base_samples, saltelli_design
from benchmark.sensitivity.indices import Sensitivity, SobolIndex, sobol_indices

__all__ = [
    "DEFAULT_BASE",
    "LEAST_BASE",
    "Sensitivity",
    "SobolIndex",
    "base_samples",
    "saltelli_design",
    "sobol_indices",
]
