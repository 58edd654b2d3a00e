"""Sections on trials: measured beside both models, and the fit behind them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.fitting import FittedParameter, SessionFit
from benchmark.models import Array
from benchmark.runs.measured import TrialPrediction
from benchmark.runs.report.values import MM
from benchmark.side_by_side import SideBySide
from reports import Block, Bullets, Column, Download, Notice, Paragraph, Section, Table
from reports.figures.fitted_parameters import FittedParameter as Dot
from reports.figures.fitted_parameters import fitted_parameters
from reports.figures.measured import measured
from reports.figures.pair import Pair
from reports.figures.trials import TrialCurve

CIRCULAR = (
    "The stiffness was fitted to these same trials, so that agreement of measured and finite elements is partly "
    "built in. The held-out column of the residual table uses the stiffness of the other trials only."
)


def fit_headline(fit: SessionFit) -> str:
    """Return the fit in one sentence."""
    found, count = fit.stiffness, len(fit.trials)
    rms = float(np.median([trial.residual_percent for trial in fit.trials]))
    return (
        f"fitted to {count} trial{'s' if count > 1 else ''}: the specimen is {found.value:.4g} times as stiff as its "
        f"file says (95 % {found.ci95_low:.4g} to {found.ci95_high:.4g}); the elastic law leaves {rms:.2g} % of the "
        "peak force (median over trials of the root mean square)"
    )


def sentence(text: str) -> str:
    """Return a clause as a sentence of its own."""
    return f"{text[0].upper()}{text[1:]}."


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
    peak = float(trial.force.max())
    return (trial.trial, trial.condition, peak, *(_rms_percent(trial.force, model, peak) for model in models))


def _rms_percent(force: Array, model: Array | None, peak: float) -> float | None:
    """Root mean square of measured minus model in % of the peak."""
    if model is None or peak <= 0.0 or not np.isfinite(model).any():
        return None
    return float(100.0 * np.sqrt(np.nanmean((force - model) ** 2)) / peak)


def fit_section(parameters: Sequence[FittedParameter], notes: Sequence[str]) -> Section:
    """Return the section on the fitted parameters."""
    fitted = [parameter for parameter in parameters if parameter.ci95_low is not None and parameter.value is not None]
    figure = fitted_parameters(
        [
            Dot(each.name, each.value or 0.0, each.unit, each.ci95_low, each.ci95_high, each.identifiable)
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
        download=Download("tables/fitted_parameters.csv", "the same"),
        folded=False,
    )
    blocks: list[Block] = [figure, table]
    if notes:
        blocks.append(Bullets(notes))
    return Section("Fitted parameters", blocks)
