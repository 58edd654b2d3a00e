"""Error against uncertainty in the style of ASME V&V 20-2009: the grid's share of it, and E, u_input, u_D, u_val.

Grids: Celik et al., J. Fluids Eng. 130:078001 (2008), for three grids of any ratio; Roache's factor of safety, 1.25
with an observed order and 3 without one. A standard uncertainty is the index over 1.15 (section 2-4.2 of the standard,
an error of one sign). The error of the model lies within E -+ u_val; where |E| <= u_val the validation cannot tell a
model error from its own noise, which is no proof that there is none (section 6-2).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from benchmark.comparison.samples import ComparisonError, Result, Row, shared_rows

OBSERVED, ASSUMED = 1.25, 3.0
COVERAGE = 1.15
LEAST_ORDER = 0.5
NORMAL_95 = 1.959963984540054
"""Half-width of a 95 % interval of the normal distribution in standard deviations."""


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


@dataclass(frozen=True)
class Validation(Result):
    """One quantity of interest, all in its unit; uncertainties are standard ones.

    Attributes
    ----------
    simulation, data : float
        S and D.
    numerical, inputs, measured : float or None
        u_num, u_input and u_D; None where it was not assessed, which counts as zero and is said.
    """

    simulation: float
    data: float
    numerical: float | None
    inputs: float | None
    measured: float | None

    @property
    def error(self) -> float:
        """E = S - D."""
        return self.simulation - self.data

    @property
    def uncertainty(self) -> float:
        """u_val, the root of the sum of squares of those assessed."""
        return math.hypot(*(each or 0.0 for each in (self.numerical, self.inputs, self.measured)))

    @property
    def missing(self) -> tuple[str, ...]:
        """Names of the uncertainties that were not assessed."""
        named = {"u_num": self.numerical, "u_input": self.inputs, "u_D": self.measured}
        return tuple(name for name, value in named.items() if value is None)

    @property
    def interval(self) -> tuple[float, float]:
        """Where the model error lies: E - u_val to E + u_val."""
        return self.error - self.uncertainty, self.error + self.uncertainty

    @property
    def within(self) -> bool:
        """Whether |E| <= u_val: no model error can be told from the noise of this validation."""
        return abs(self.error) <= self.uncertainty

    def rows(self) -> list[Row]:
        """Lines for a table."""
        low, high = self.interval
        return shared_rows(
            {
                "E": self.error,
                "u_num": self.numerical,
                "u_input": self.inputs,
                "u_D": self.measured,
                "u_val": self.uncertainty,
                "model error low": low,
                "model error high": high,
            }
        )


def replicate_uncertainty(values: Sequence[float], conditions: Sequence[str] | None = None) -> float | None:
    """u_D of the mean of replicate trials: standard deviation (n - 1) over root n; None with fewer than two.

    Of several conditions, of each trial in `conditions`, their mean's: what they differ by is no scatter. Those with
    one trial are taken to scatter as the others do; None where none has two.

    Raises
    ------
    ComparisonError
        A value that is not finite.
    """
    found = np.asarray(values, dtype=float)
    if not np.isfinite(found).all():
        raise ComparisonError(f"replicates {list(values)}: all must be finite")
    names = np.zeros(found.size) if conditions is None else np.array(conditions)
    left = found - np.array([found[names == name].mean() for name in names])
    freedom = found.size - np.unique(names).size
    return float(np.sqrt(left @ left / freedom / found.size)) if freedom > 0 else None


def input_uncertainty(sensitivity: float, ci95: tuple[float, float], freedom: int | None = None) -> float:
    """u_input of one parameter: |dS/dp| times the standard uncertainty of its 95 % interval.

    That is its half-width over the quantile: Student's for the degrees of freedom it was made with, or 1.96.
    """
    quantile = NORMAL_95 if freedom is None else float(scipy.stats.t.ppf(0.975, freedom))
    return abs(sensitivity) * 0.5 * abs(ci95[1] - ci95[0]) / quantile
