"""What a page says of trials, whether they come from a run at hand or from the files of an earlier one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from benchmark.fitting import FittedParameter
from benchmark.runs.measured import MeasuredComparison, TrialPrediction
from benchmark.runs.report.film_part import FilmPart, film_part
from benchmark.runs.report.film_section import measured_headline


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
    markers
        What the films of the trials show; None without any.
    """

    trials: Sequence[TrialPrediction]
    synthetic: bool
    headline: str
    parameters: Sequence[FittedParameter]
    notes: Sequence[str]
    markers: FilmPart | None = None

    @classmethod
    def of(cls, measured: MeasuredComparison) -> TrialsPart:
        """Return the part of a run at hand."""
        fit = measured.fit
        markers = None if measured.filmed is None else film_part(measured, measured.filmed)
        headline, synthetic = measured_headline(measured), measured.session.synthetic
        return cls(measured.trials, synthetic, headline, fit.parameters, fit.notes, markers)
