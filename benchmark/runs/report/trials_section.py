"""Sections on trials: measured beside both models and the fit behind them, from a run at hand or from its files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.identification import FittedParameter
from benchmark.models import Array
from benchmark.runs.report.film_section import FilmPart, film_part
from benchmark.runs.report.values import MM, measured_headline
from benchmark.runs.trials.measured import MeasuredComparison, TrialPrediction, peak_force
from benchmark.side_by_side import SideBySide
from reports import Block, Bullets, Column, Download, Notice, Paragraph, Section, Table
from reports.figures.measured import TrialCurve, measured
from reports.figures.rows import ParameterRow, fitted_parameters
from reports.figures.style import Pair


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


TABLE_ONE = ("published.", "sound.")
"""Rows of the article's Table 1: of many units, they stand in the table and not in the figure."""

CIRCULAR = (
    "The stiffness was fitted to these same trials, so that agreement of measured and finite elements is partly "
    "built in. The held-out column of the residual table uses the stiffness of the other trials only."
)


def session_notices(synthetic: bool) -> tuple[Notice, ...]:
    """What must be known of the data before any figure."""
    notices = []
    if synthetic:
        notices.append(Notice("synthetic", "These trials were computed, not measured. They show that the chain works."))
    notices.append(Notice("circular", CIRCULAR))
    return tuple(notices)


def measured_section(trials: Sequence[TrialPrediction], synthetic: bool, pair: SideBySide) -> Section:
    """Return the section on trials beside both models, called what `pair` calls them."""
    curves = [
        TrialCurve(
            trial.trial,
            trial.condition,
            MM * trial.depth,
            trial.force,
            trial.fem_force,
            trial.wave_force,
        )
        for trial in trials
    ]
    text = (
        "Each trial's measured depth drives the models; contact onset and force zero are the trial's own, the "
        "stiffness is the session's."
    )
    blocks: list[Block] = [
        Paragraph(text),
        measured(curves, synthetic, Pair.named(pair.fem.own, pair.wave.own)),
        _residuals(trials, pair),
    ]
    return Section("Measured against the models", blocks)


def _residuals(trials: Sequence[TrialPrediction], pair: SideBySide) -> Table:
    columns = (
        "trial",
        "condition",
        Column("peak force", "N"),
        Column("FEM residual, rms", "% of peak", 3),
        Column(f"{pair.wave.name} residual, rms", "% of peak", 3),
        Column("FEM residual held out, rms", "% of peak", 3),
    )
    rows = [_residual_row(trial) for trial in trials]
    return Table(
        "Measured minus model, root mean square over the trial, in % of its peak force",
        columns,
        rows,
        download=Download("tables/measured.csv", "every row"),
    )


def _residual_row(trial: TrialPrediction) -> tuple[object, ...]:
    models = (trial.fem_force, trial.wave_force, trial.held_out_force)
    peak = peak_force(trial.time, trial.force)
    return (trial.trial, trial.condition, peak, *(_rms_percent(trial.force, model, peak) for model in models))


def _rms_percent(force: Array, model: Array | None, peak: float) -> float | None:
    """Root mean square of measured minus model in % of the peak."""
    if model is None or peak <= 0.0 or not np.isfinite(model).any():
        return None
    return float(100.0 * np.sqrt(np.nanmean((force - model) ** 2)) / peak)


def fit_section(parameters: Sequence[FittedParameter], notes: Sequence[str], href: str) -> Section:
    """Return the section on the fitted parameters, whose table is the file `href` beside the page."""
    fitted = [
        parameter
        for parameter in parameters
        if parameter.ci95_low is not None and parameter.value is not None and not parameter.name.startswith(TABLE_ONE)
    ]
    figure = fitted_parameters(
        [
            ParameterRow(each.name, each.value or 0.0, each.unit, each.ci95_low, each.ci95_high, each.identifiable)
            for each in fitted
        ]
    )
    columns = (
        "parameter",
        Column("value"),
        "unit",
        Column("95 % low"),
        Column("95 % high"),
        "identifiable",
        "source",
    )
    rows = [
        (p.name, p.value, p.unit, p.ci95_low, p.ci95_high, "yes" if p.identifiable else "no", p.source)
        for p in parameters
    ]
    table = Table(
        "Parameters, fitted and fixed",
        columns,
        rows,
        download=Download(href, "the same"),
        folded=False,
    )
    blocks: list[Block] = [figure, table]
    if notes:
        blocks.append(Bullets(notes))
    return Section("Fitted parameters", blocks)
