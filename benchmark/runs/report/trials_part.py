"""What a page says of trials, whether they come from a run at hand or from the files of an earlier one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from benchmark.fitting import FittedParameter
from benchmark.runs.measured import MeasuredComparison, TrialPrediction
from benchmark.runs.report.measured_section import fit_headline


@dataclass(frozen=True)
class TrialsPart:
    """Trials beside the models, and the fit behind them.

    Attributes
    ----------
    trials
        Each with both models' forces.
    synthetic
        Whether they were computed, not measured.
    headline
        The fit in one sentence.
    parameters, notes
        Of the fit.
    """

    trials: Sequence[TrialPrediction]
    synthetic: bool
    headline: str
    parameters: Sequence[FittedParameter]
    notes: Sequence[str]

    @classmethod
    def of(cls, measured: MeasuredComparison) -> TrialsPart:
        """Return the part of a run at hand."""
        fit = measured.fit
        return cls(measured.trials, measured.session.synthetic, fit_headline(fit), fit.parameters, fit.notes)
