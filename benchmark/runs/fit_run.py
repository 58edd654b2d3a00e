"""`fit`: a session's fit as a folder of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.identification import parameter_columns
from benchmark.response.model_with_effects import load_repair
from benchmark.runs.destination import destination
from benchmark.runs.document import describe_environment
from benchmark.runs.listener import Listener
from benchmark.runs.report import fit_page
from benchmark.runs.session_run import fit_trials
from reports import whole_folder, write_csv, write_json, write_page


@dataclass(frozen=True)
class FitOutcome:
    """A finished fit on disk: its folder, the content of `fit.json`, its headline and its warnings."""

    folder: Path
    document: dict[str, Any]
    headline: str
    warnings: tuple[str, ...]


def fit_to_folder(
    path: Path,
    specimen: str | None,
    settings: Mapping[str, str],
    out: Path | None,
    *,
    seed: int,
    listener: Listener,
    model: Path | None = None,
    effects: Path | None = None,
) -> FitOutcome:
    """Fit a session and write fit.json, fitted_parameters.csv and report.html.

    With a `model` file its effects are in the fit; `effects` is the user's own file that it may name.

    Raises
    ------
    InputError, SolverError
        See `benchmark.runs.session_run.fit_trials`.
    OSError
        Where the file system refuses; `out` is then as it was.
    """
    if effects is not None and model is None:
        raise InputError("--effects brings effects that a model file names: give --model with it")
    destination(out, "", (path, model, effects, specimen, *settings.values()))
    repair = None if model is None else load_repair(model, effects)
    found = fit_trials(path, specimen, settings, listener, repair=repair)
    session, fit, warnings = found.session, found.fit, found.warnings
    sheet = None if found.filmed is None else found.filmed.sheet
    document = {
        **fit.to_dict(),
        **({} if sheet is None else {"sheet": sheet.to_dict()}),
        "session": {"name": session.name, "fingerprint": session.fingerprint, "synthetic": session.synthetic},
        "specimen": session.specimen.name,
        "warnings": list(warnings),
        **({} if repair is None else {"effects": list(repair.slugs)}),
    }
    page = fit_page(session, fit, warnings, describe_environment(seed=seed), sheet)
    folder = destination(out, f"{session.name}-fit")
    with whole_folder(folder) as new:
        write_json(new / "fit.json", document)
        write_csv(new / "fitted_parameters.csv", parameter_columns(fit.parameters))
        write_page(new / "report.html", page)
    return FitOutcome(folder, document, page.verdict.headline, warnings)
