"""What the fit of one trial gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmark.fitting.holds import Hold


@dataclass(frozen=True)
class TrialFit:
    """Result for one trial, SI.

    Attributes
    ----------
    name, condition : str
    rows, rows_fitted : int
        Measured rows, and rows after averaging and leaving out what the curve does not reach.
    log_stiffness, log_stiffness_stderr : float
        Natural logarithm of the stiffness factor; standard error widened for autocorrelation.
    zero, zero_stderr : float
        Force without contact, N.
    rest : float
        Force where the trial is least deep, N; the zero unless the trial starts in contact.
    onset, onset_stderr : float
        Depth at first contact, m; standard error 0 where the onset is at its bound.
    onset_range : (low, high)
        What the data allow, m.
    peak : float
        Largest force above the zero, N; of a long trial, of its averaged rows.
    residual_rms, residual_max : float
        N, over all measured rows that the curve reaches.
    lag_one, effective_rows : float
        Autocorrelation of the residual and the number of independent samples it leaves.
    hold : Hold or None
        The loaded hold in which the force falls most.
    contact_from_loading : bool
        Whether onset and zero come from the rows up to the largest force only.
    correlations : mapping
        Between the fitted parameters, by "a, b".
    notes : tuple of str
    """

    name: str
    condition: str
    rows: int
    rows_fitted: int
    log_stiffness: float
    log_stiffness_stderr: float
    zero: float
    zero_stderr: float
    rest: float
    onset: float
    onset_stderr: float
    onset_range: tuple[float, float]
    peak: float
    residual_rms: float
    residual_max: float
    lag_one: float
    effective_rows: float
    hold: Hold | None
    contact_from_loading: bool
    correlations: Mapping[str, float]
    notes: tuple[str, ...]

    @property
    def key(self) -> tuple[str, str]:
        """Condition and name."""
        return self.condition, self.name

    @property
    def stiffness(self) -> float:
        """Stiffness factor of this trial alone."""
        return float(np.exp(self.log_stiffness))

    @property
    def residual_percent(self) -> float:
        """Root-mean-square residual in % of the peak."""
        return 100.0 * self.residual_rms / self.peak

    @property
    def onset_at_bound(self) -> bool:
        """Whether the data only bound the onset."""
        low, high = self.onset_range
        return self.onset in (low, high)

    @property
    def time_dependent(self) -> bool:
        """Whether the force falls in a hold, beyond the noise."""
        return self.hold is not None and self.hold.seen

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`, with units in the keys."""
        return {
            "name": self.name,
            "condition": self.condition,
            "rows": self.rows,
            "rows_fitted": self.rows_fitted,
            "stiffness_factor": self.stiffness,
            "log_stiffness_factor": self.log_stiffness,
            "log_stiffness_factor_stderr": self.log_stiffness_stderr,
            "zero_N": self.zero,
            "zero_stderr_N": self.zero_stderr,
            "rest_N": self.rest,
            "onset_mm": 1e3 * self.onset,
            "onset_stderr_mm": 1e3 * self.onset_stderr,
            "onset_range_mm": [1e3 * end for end in self.onset_range],
            "onset_at_bound": self.onset_at_bound,
            "peak_N": self.peak,
            "residual_rms_N": self.residual_rms,
            "residual_rms_percent_of_peak": self.residual_percent,
            "residual_max_percent_of_peak": 100.0 * self.residual_max / self.peak,
            "residual_lag_one": self.lag_one,
            "effective_rows": self.effective_rows,
            "hold_decay_percent": None if self.hold is None else self.hold.decay_percent,
            "hold": None if self.hold is None else self.hold.to_dict(),
            "correlations": dict(self.correlations),
            "notes": list(self.notes),
        }
