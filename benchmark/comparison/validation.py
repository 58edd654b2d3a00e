"""Error against uncertainty in the style of ASME V&V 20-2009: E, u_num, u_input, u_D, u_val, and what may be concluded.

The error of the model lies within E -+ u_val (one standard uncertainty); where |E| <= u_val the validation cannot tell
a model error from its own noise, which is no proof that there is none (section 6-2 of the standard).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.comparison.errors import ComparisonError
from benchmark.comparison.result import Result, Row


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
        return [
            ("E", None, None, self.error),
            ("u_num", None, None, self.numerical),
            ("u_input", None, None, self.inputs),
            ("u_D", None, None, self.measured),
            ("u_val", None, None, self.uncertainty),
            ("model error low", None, None, low),
            ("model error high", None, None, high),
        ]


def replicate_uncertainty(values: Sequence[float]) -> float | None:
    """u_D of the mean of replicate trials: standard deviation (n - 1) over root n; None with fewer than two.

    Raises
    ------
    ComparisonError
        A value that is not finite.
    """
    found = np.asarray(values, dtype=float)
    if not np.isfinite(found).all():
        raise ComparisonError(f"replicates {list(values)}: all must be finite")
    return float(np.std(found, ddof=1) / math.sqrt(found.size)) if found.size > 1 else None


def input_uncertainty(sensitivity: float, ci95: tuple[float, float]) -> float:
    """u_input of one parameter: |dS/dp| times the standard uncertainty of its 95 % interval (half-width / 1.96)."""
    return abs(sensitivity) * 0.5 * abs(ci95[1] - ci95[0]) / 1.959963984540054
