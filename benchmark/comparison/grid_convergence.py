"""Numerical uncertainty of a value from a series of grids: Richardson's extrapolation and the grid convergence index.

Celik et al., J. Fluids Eng. 130:078001 (2008), for three grids of any ratio; Roache's factor of safety, 1.25 with an
observed order and 3 without one. A standard uncertainty is the index over 1.15 (ASME V&V 20-2009, section 2-4.2, an
error of one sign).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from benchmark.comparison.errors import ComparisonError
from benchmark.comparison.result import Result

OBSERVED, ASSUMED = 1.25, 3.0
COVERAGE = 1.15
LEAST_ORDER = 0.5


@dataclass(frozen=True)
class GridConvergence(Result):
    """What a series of grids tells about the value on one of them.

    Attributes
    ----------
    value : float
        On the grid that is judged.
    extrapolated : float
        Richardson's estimate for a grid of no size.
    order : float
        Observed order, or the one assumed.
    observed : bool
        Whether it was observed; False where the values do not fall in line, or there are two grids only.
    index : float
        Factor of safety times |value - extrapolated|, in the unit of the value.
    uncertainty : float
        Standard uncertainty, index / 1.15.
    """

    value: float
    extrapolated: float
    order: float
    observed: bool
    index: float
    uncertainty: float


def grid_convergence(
    values: Sequence[float], sizes: Sequence[float], judged: int = 0, formal_order: float = 2.0
) -> GridConvergence:
    """Judge the value of one grid in a series.

    Parameters
    ----------
    values
        Two or three values, the finest grid's first, in one unit.
    sizes
        Representative cell sizes of the grids, rising.
    judged
        Which of them is the one in use; 0 is the finest.
    formal_order
        Order of the method: the largest that is believed, and the one assumed where none can be observed.

    Raises
    ------
    ComparisonError
        Another number of grids, sizes that do not rise, values that are not finite.
    """
    found, steps = np.asarray(values, dtype=float), np.asarray(sizes, dtype=float)
    if found.shape != steps.shape or found.size not in (2, 3) or not np.isfinite(found).all():
        raise ComparisonError(f"values {values}, sizes {sizes}: needed: two or three finite values, a size each")
    if steps[0] <= 0.0 or (np.diff(steps) <= 0.0).any():
        raise ComparisonError(f"sizes {sizes}: they must be above zero and rise, the finest grid first")
    order = _observed_order(found, steps) if found.size == 3 else None
    observed = order is not None and order >= LEAST_ORDER
    power = min(float(order), formal_order) if order is not None and observed else formal_order
    fine, coarse = float(found[0]), float(found[1])
    limit = fine + (fine - coarse) / ((steps[1] / steps[0]) ** power - 1.0)
    away = max(abs(float(found[judged]) - limit), 0.0 if observed else float(np.ptp(found)) / 2.0)
    index = (OBSERVED if observed else ASSUMED) * away
    return GridConvergence(float(found[judged]), float(limit), power, observed, index, index / COVERAGE)


def _observed_order(values: np.ndarray, sizes: np.ndarray) -> float | None:
    """Order p at which three grids fall in line; None where they oscillate, diverge or do not differ."""
    near, far = values[1] - values[0], values[2] - values[1]
    if near == 0.0 or far / near <= 0.0:
        return None
    first, second = sizes[1] / sizes[0], sizes[2] / sizes[1]

    def mismatch(p: float) -> float:
        return float(far / near - first**p * (second**p - 1.0) / (first**p - 1.0))

    low, high = 1e-3, 20.0
    if mismatch(low) * mismatch(high) > 0.0:
        return None
    return float(scipy.optimize.brentq(mismatch, low, high, xtol=1e-12))
