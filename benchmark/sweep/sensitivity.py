"""The Sobol indices of a sweep's results."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from benchmark.sensitivity import Sensitivity, sobol_indices
from benchmark.sweep.plan import SweepPlan
from benchmark.sweep.point import PointResult
from benchmark.sweep.results import SECONDS

COLUMNS = ("result", "parameter", "first_order", "first_order_ci95", "total_order", "total_order_ci95")


def sweep_sensitivity(plan: SweepPlan, rows: Sequence[PointResult]) -> Sensitivity:
    """Indices of every result but the compute times, from all points of a saltelli design in their order."""
    names = dict.fromkeys(name for row in rows for name in row.values if not name.endswith(SECONDS))
    results = {name: np.array([row.values.get(name, np.nan) for row in rows]) for name in names}
    return sobol_indices([parameter.key for parameter in plan.parameters], results, seed=plan.design.seed)


def sensitivity_columns(found: Sensitivity) -> dict[str, list[Any]]:
    """Columns of `sensitivity.csv`; the intervals as half-widths at 95 %."""
    lines = [
        (index.result, index.parameter, index.first, index.first_ci95, index.total, index.total_ci95)
        for index in found.indices
    ]
    return {name: [line[place] for line in lines] for place, name in enumerate(COLUMNS)}
