"""The page of a fit alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmark.files import Session
from benchmark.identification import SessionFit, SheetFit
from benchmark.identification.pooling import counted_trials
from benchmark.runs.report.trials_section import fit_section
from benchmark.runs.report.values import fit_headline, sentence, sheet_headline
from reports import Column, Download, Fact, Notice, Page, Section, Table, Verdict

FITTED = "fitted_parameters.csv"


def fit_page(
    session: Session,
    fit: SessionFit,
    warnings: Sequence[str],
    environment: Mapping[str, Any],
    sheet: SheetFit | None = None,
) -> Page:
    """Return the page of a session's fit, with that of its markers where there are any."""
    headline = fit_headline(fit) if sheet is None else sheet_headline(sheet)
    notices = []
    if session.synthetic:
        notices.append(Notice("synthetic", "These trials were computed, not measured."))
    if warnings:
        notices.append(Notice("warning", "Read these before you quote a figure.", warnings))
    return Page(
        title=f"{session.name}: fit",
        subtitle=f"{counted_trials(len(session.trials))} of {session.specimen.name}",
        verdict=Verdict("finding", sentence(headline)),
        facts=(Fact("Made", str(environment["made"])), Fact("Session", session.fingerprint[:16])),
        notices=notices,
        sections=(fit_section(fit.parameters, fit.notes, FITTED), Section("Trials", (_trials(fit),))),
        downloads=(
            Download(FITTED, "fitted and fixed parameters with intervals"),
            Download("fit.json", "the fit for programs", media_type="application/json"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _trials(fit: SessionFit) -> Table:
    columns = (
        "trial",
        "condition",
        Column("stiffness factor"),
        Column("contact onset", "mm"),
        Column("zero", "N"),
        Column("peak force", "N"),
        Column("residual, rms", "% of peak", 3),
        Column("decay in the hold", "%", 3),
    )
    rows = [
        (
            trial.name,
            trial.condition,
            trial.stiffness,
            1e3 * trial.onset,
            trial.zero,
            trial.peak,
            trial.residual_percent,
            None if trial.hold is None else trial.hold.decay_percent,
        )
        for trial in fit.trials
    ]
    return Table("Each trial fitted by itself", columns, rows)
