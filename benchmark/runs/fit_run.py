"""`fit`: from a session to its fit, and the fit as a folder of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.exchange import FORMATS, export_text
from benchmark.experiments.parameters_answer import ParametersAnswer
from benchmark.files import Load, Scenario, Session, Support, Tissue, Tool
from benchmark.identification import FittedParameter, SheetFit, parameter_columns
from benchmark.identification.parameters.free_parameters import RELAXATION
from benchmark.identification.parameters.identified import Identified
from benchmark.identification.parameters.identified_tissue import identified_tissue
from benchmark.identification.session_fit import elastic_only
from benchmark.model_file import RepairedModel
from benchmark.response.model_with_effects import load_repair
from benchmark.runs.fitted_session import FittedSession, fit_trials
from benchmark.runs.options import Listener
from benchmark.runs.output.destination import claimed, destination
from benchmark.runs.output.document import describe_environment
from benchmark.runs.parameters_run import ParameterWish, answer_of, common_factor_warnings, with_setup
from benchmark.runs.report import fit_page
from benchmark.runs.report.parameters_page import parameters_page
from benchmark.runs.report.values import fit_headline, sentence, sheet_headline
from reports import Page, Verdict, write_csv, write_json, write_page, write_text, write_whole

ROWS, SECONDS = 20, 10.0
"""Steps and duration of an exported press; without relaxation the duration is of no account."""
UNSETTLED = "not settled"


@dataclass(frozen=True)
class FitRequest:
    """What is fitted: a session, the tissue of its trials, settings by KEY, a model file whose effects are in the fit.

    `effects` is the user's own file that the model file may name; `wish` says which parameters are free; `export` are
    endings of input files for other codes.
    """

    session: Path
    specimen: str | None = None
    settings: Mapping[str, str] = field(default_factory=dict)
    model: Path | None = None
    effects: Path | None = None
    seed: int = 0
    wish: ParameterWish = field(default_factory=ParameterWish)
    export: tuple[str, ...] = ()


@dataclass(frozen=True)
class FitRecord:
    """A fit before it is written.

    Attributes
    ----------
    found
        The session with its fit of one common stiffness.
    repair
        Effects that were switched on.
    seed
    parameters
        The fit of parameters; None where none were free.
    exported
        Input files for other codes: names and texts.
    """

    found: FittedSession
    repair: RepairedModel | None
    seed: int
    parameters: ParametersAnswer | None = None
    exported: tuple[tuple[str, str], ...] = ()

    @property
    def sheet(self) -> SheetFit | None:
        """The fit of force and markers together; None without markers."""
        return None if self.found.filmed is None else self.found.filmed.sheet

    @property
    def headline(self) -> str:
        """The fit in one sentence, which begins with that it did not settle where it did not."""
        if self.parameters is not None:
            said = self.parameters.headline
        else:
            said = fit_headline(self.found.fit) if self.sheet is None else sheet_headline(self.sheet)
        return said if self.settled else f"{UNSETTLED}: {said}"

    @property
    def settled(self) -> bool:
        """Whether the rounds of the fit came to rest, with its free parameters or with the effects of a model file."""
        return self.found.settled if self.identified is None else self.identified.found.settled

    def document(self) -> dict[str, Any]:
        """The content of `fit.json`."""
        session = self.found.session
        common = self.found.fit.to_dict()
        if self.parameters is not None:
            common = {**common, "common_factor": common["parameters"], **self.parameters.to_dict()}
        return {
            **common,
            "settled": self.settled,
            **({} if self.sheet is None else {"sheet": self.sheet.to_dict()}),
            "session": {
                "name": session.name,
                "fingerprint": session.fingerprint,
                "synthetic": session.synthetic,
                **({"heights_mm": heights} if (heights := _heights(session)) else {}),
            },
            "specimen": session.specimen.name,
            "warnings": list(self.warnings),
            **({} if self.repair is None else {"effects": list(self.repair.slugs)}),
        }

    def page(self) -> Page:
        """The page of the fit."""
        found, environment = self.found, describe_environment(seed=self.seed)
        if self.parameters is not None:
            page = parameters_page(found.session, self.parameters, self.warnings, environment)
        else:
            page = fit_page(found.session, found.fit, self.warnings, environment, self.sheet)
        return page if self.settled else replace(page, verdict=Verdict("incomplete", sentence(self.headline)))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the reader must know: of the parameters first, where some were free."""
        return self.found.warnings if self.parameters is None else (*self.parameters.warnings, *self.found.warnings)

    @property
    def identified(self) -> Identified | None:
        """The fit of parameters alone."""
        return None if self.parameters is None else self.parameters.identified

    @property
    def rows(self) -> tuple[FittedParameter, ...]:
        """Rows of `fitted_parameters.csv`."""
        return self.found.fit.parameters if self.identified is None else self.identified.rows

    def texts(self) -> list[tuple[str, str]]:
        """The tissue file of each specimen and the protocols of what to measure next, by their names."""
        if self.parameters is None:
            return []
        answer = self.parameters.identified
        names = ["identified.toml", *(f"identified_{number}.toml" for number in range(2, len(answer.specimens) + 1))]
        out = [(name, identified_tissue(answer, number).to_toml()) for number, name in enumerate(names)]
        design = self.parameters.design
        if design is not None:
            out += [("next_experiment.toml", design.best_d.toml()), ("next_experiment_a.toml", design.best_a.toml())]
        return [*out, *self.exported]


def _heights(session: Session) -> dict[str, float]:
    """Height of the specimen under each trial that has its own, mm."""
    return {each.name: 1e3 * each.height for each in session.trials if each.height is not None}


@dataclass(frozen=True)
class FitOutcome:
    """A finished fit on disk: its folder, the content of `fit.json`, headline, warnings, and whether it settled."""

    folder: Path
    document: dict[str, Any]
    headline: str
    warnings: tuple[str, ...]
    settled: bool = True


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
    check = partial(_check, request)
    found = fit_trials(request.session, request.specimen, request.settings, listener, repair=repair, check=check)
    table = request.wish.table(found.session.fit)
    if not table.free:
        if repair is None:
            said = common_factor_warnings(found, listener)
            found = with_setup(replace(found, warnings=(*said, *found.warnings)), table.exact, listener)
        return FitRecord(found, repair, request.seed)
    others = [fit_trials(path, request.specimen, request.settings, listener) for path in request.wish.sessions]
    answer = answer_of((found, *others), request.wish, table, listener)
    exported, said = exports(answer.identified, request.export)
    theirs = (f"{one.session.name}: {text}" for one in others for text in one.warnings if text not in found.warnings)
    other = table.law is not None or any(key.endswith(RELAXATION) for key in table.free)
    followed = bool(answer.identified.held_out) and not answer.identified.conflict and not others
    idle = elastic_only(found.fit.trials, followed=followed) if other else ()  # of a law that is not what was fitted
    own = (text for text in found.warnings if text not in idle)
    found = replace(found, warnings=(*own, *theirs, *said))
    return FitRecord(found, repair, request.seed, answer, exported)


def _check(request: FitRequest, session: Session) -> None:
    """Refuse what cannot be fitted, or not be written, before anything is computed; raises InputError."""
    request.wish.check(session)
    table = request.wish.table(session.fit)
    free = bool(table.free)
    if table.exact and not free and request.model is not None:
        raise InputError(
            f"exact {table.exact[0]} is of no use with --model: no uncertainty of the set-up is worked out there; "
            "leave it out (of --exact, or of [fit])"
        )
    if free and request.model is not None:
        raise InputError(
            "--free and --model do not go together: the effects of a model file are fitted with one "
            "common stiffness. Leave --free out for that, or leave --model out and fit what is an effect of the "
            "material along: --free KEY,relaxation, or --law yeoh with --free KEY where it stiffens"
        )
    check_exports(session, request.export, free=free)


def fit_to_folder(request: FitRequest, out: Path | None, listener: Listener) -> FitOutcome:
    """Fit a session and write its folder, whose place is checked first.

    Raises
    ------
    InputError, SolverError
        See `carry_out_fit` and `destination`.
    OSError
        Where the file system refuses; `out` is then as it was.
    """
    sessions = (request.session, *request.wish.sessions)
    inputs = (*sessions, request.model, request.effects, request.specimen, *request.settings.values())
    with claimed(out, "fit"):
        destination(out, "", inputs)
        record = carry_out_fit(request, listener)
        return write_fit(record, out or destination(None, f"{record.found.session.name}-fit"))


def write_fit(record: FitRecord, folder: Path) -> FitOutcome:
    """Write fit.json, fitted_parameters.csv and report.html; raises OSError, and `folder` is then as it was."""
    document, page = record.document(), record.page()

    def fill(new: Path) -> None:
        write_json(new / "fit.json", document)
        write_csv(new / "fitted_parameters.csv", parameter_columns(record.rows))
        write_page(new / "report.html", page)
        for name, text in record.texts():
            write_text(new / name, text)

    write_whole(folder, fill)
    return FitOutcome(folder, document, page.verdict.headline, record.warnings, record.settled)


def check_exports(session: Session, endings: Sequence[str], *, free: bool) -> None:
    """Refuse, before a fit, formats and set-ups that cannot be written.

    Raises
    ------
    InputError
        By name, as `benchmark.exchange.export_text`; or nothing is free, so that nothing will be identified.
    """
    if endings and not free:
        raise InputError("--export writes what was identified: give --free KEY,KEY with it")
    unknown = [ending for ending in endings if ending not in FORMATS]
    if unknown:
        raise InputError(f"--export {unknown[0]}: no such format; allowed: {', '.join(FORMATS)}")
    for tissue, tool, support in session.setups:
        for ending in endings:
            export_text(_press(session, tissue, tool, support, 0.1 * tissue.layers[0].thickness), ending)


def exports(answer: Identified, endings: Sequence[str]) -> tuple[tuple[tuple[str, str], ...], tuple[str, ...]]:
    """Names and texts of the files, one a set-up and format; and what could not be written, in words."""
    out, said = [], []
    for number, press in enumerate(answer.found.problem.presses, start=1):
        tissue = identified_tissue(answer, press.specimen)
        scenario = _press(press.session, tissue, *press.setup[1:], press.depth)
        for ending in endings:
            try:
                out.append((f"identified_press_{number}.{ending}", export_text(scenario, ending)))
            except InputError as error:
                said.append(f"press {number} was not written: {error}")
    return tuple(out), tuple(said)


def _press(session: Session, tissue: Tissue, tool: Tool, support: Support, depth: float) -> Scenario:
    load = Load(control="depth", peak=depth, shape="ramp", duration=SECONDS, observations=ROWS)
    return session.scenario(tissue, tool, support, load)
