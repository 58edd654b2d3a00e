"""`fit`: from a session to its fit, and the fit as a folder of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.identification import SheetFit, parameter_columns
from benchmark.model_file import RepairedModel
from benchmark.response.model_with_effects import load_repair
from benchmark.runs.fitted_session import FittedSession, fit_trials
from benchmark.runs.options import Listener
from benchmark.runs.output.destination import destination
from benchmark.runs.output.document import describe_environment
from benchmark.runs.report import fit_page
from benchmark.runs.report.values import fit_headline, sheet_headline
from reports import Page, whole_folder, write_csv, write_json, write_page


@dataclass(frozen=True)
class FitRequest:
    """What is fitted: a session, the tissue of its trials, settings by KEY, a model file whose effects are in the fit.

    `effects` is the user's own file that the model file may name.
    """

    session: Path
    specimen: str | None = None
    settings: Mapping[str, str] = field(default_factory=dict)
    model: Path | None = None
    effects: Path | None = None
    seed: int = 0


@dataclass(frozen=True)
class FitRecord:
    """A fit before it is written: what was found, with which effects switched on, and the seed."""

    found: FittedSession
    repair: RepairedModel | None
    seed: int

    @property
    def sheet(self) -> SheetFit | None:
        """The fit of force and markers together; None without markers."""
        return None if self.found.filmed is None else self.found.filmed.sheet

    @property
    def headline(self) -> str:
        """The fit in one sentence."""
        return fit_headline(self.found.fit) if self.sheet is None else sheet_headline(self.sheet)

    def document(self) -> dict[str, Any]:
        """The content of `fit.json`."""
        session = self.found.session
        return {
            **self.found.fit.to_dict(),
            **({} if self.sheet is None else {"sheet": self.sheet.to_dict()}),
            "session": {"name": session.name, "fingerprint": session.fingerprint, "synthetic": session.synthetic},
            "specimen": session.specimen.name,
            "warnings": list(self.found.warnings),
            **({} if self.repair is None else {"effects": list(self.repair.slugs)}),
        }

    def page(self) -> Page:
        """The page of the fit."""
        found = self.found
        return fit_page(found.session, found.fit, found.warnings, describe_environment(seed=self.seed), self.sheet)


@dataclass(frozen=True)
class FitOutcome:
    """A finished fit on disk: its folder, the content of `fit.json`, its headline and its warnings."""

    folder: Path
    document: dict[str, Any]
    headline: str
    warnings: tuple[str, ...]


def carry_out_fit(request: FitRequest, listener: Listener) -> FitRecord:
    """Fit a session; nothing is written.

    Raises
    ------
    InputError, SolverError
        See `benchmark.runs.session_run.fit_trials`.
    """
    if request.effects is not None and request.model is None:
        raise InputError("--effects brings effects that a model file names: give --model with it")
    repair = None if request.model is None else load_repair(request.model, request.effects)
    found = fit_trials(request.session, request.specimen, request.settings, listener, repair=repair)
    return FitRecord(found, repair, request.seed)


def fit_to_folder(request: FitRequest, out: Path | None, listener: Listener) -> FitOutcome:
    """Fit a session and write its folder, whose place is checked first.

    Raises
    ------
    InputError, SolverError
        See `carry_out_fit` and `destination`.
    OSError
        Where the file system refuses; `out` is then as it was.
    """
    destination(
        out, "", (request.session, request.model, request.effects, request.specimen, *request.settings.values())
    )
    record = carry_out_fit(request, listener)
    return write_fit(record, destination(out, f"{record.found.session.name}-fit"))


def write_fit(record: FitRecord, folder: Path) -> FitOutcome:
    """Write fit.json, fitted_parameters.csv and report.html; raises OSError, and `folder` is then as it was."""
    document, page = record.document(), record.page()
    with whole_folder(folder) as new:
        write_json(new / "fit.json", document)
        write_csv(new / "fitted_parameters.csv", parameter_columns(record.found.fit.parameters))
        write_page(new / "report.html", page)
    return FitOutcome(folder, document, page.verdict.headline, record.found.warnings)
