"""`fit --free`: parameters of one or several sessions; and the warnings of one factor for several layers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from benchmark.errors import InputError, SolverError
from benchmark.experiments.optimal_design import designed
from benchmark.experiments.parameters_answer import ParametersAnswer
from benchmark.files import Session, Setup
from benchmark.files.schema import validated
from benchmark.files.sessions.fit_table import FitTable
from benchmark.files.sessions.session_folder import SESSION_FILE
from benchmark.files.sources import Source, read_toml
from benchmark.identification.parameters.fit_problem import FitProblem
from benchmark.identification.parameters.free_parameters import (
    COMMON,
    EDGE_RADIUS,
    MODULUS,
    parameters_of,
    refuse_without_effect,
)
from benchmark.identification.parameters.identifiability import directions
from benchmark.identification.parameters.identified import Identified, identify
from benchmark.identification.parameters.law_selection import scores, simplest
from benchmark.identification.parameters.law_shapes import law_shape
from benchmark.identification.parameters.layer_fit import SEARCH, LayerFit, begun, fit_layers
from benchmark.identification.parameters.other_answers import other_answers
from benchmark.identification.parameters.posterior import load_emcee, posterior
from benchmark.identification.parameters.pressed_set_ups import followed
from benchmark.identification.parameters.presses.press_surrogate import PressSurrogate
from benchmark.identification.parameters.session_problem import (
    Assembled,
    FittedBase,
    assembled,
    check_exact,
    check_wish,
)
from benchmark.identification.pooling import widened
from benchmark.identification.trial_data import FittingError, TrialData
from benchmark.identification.trial_fit import fit_trial
from benchmark.response.force_curve import ForceCurve
from benchmark.response.least_squares import least_squares
from benchmark.response.ramp_table import EVERYWHERE
from benchmark.runs.fitted_session import FittedSession
from benchmark.runs.options import Listener
from reports.formatting import counted

BETTER = 6.0
"""Gain of -2 log likelihood per further parameter from which free layers follow the trials better than one factor.

Beyond the 0.99 quantile of chi squared with one degree of freedom (6.6) for one parameter, more than that for several.
"""

MOVE = 0.01
"""By which a coordinate of the set-up is moved to see what it does to a stiffness."""


@dataclass(frozen=True)
class ParameterWish:
    """What the command line, or a script, says of a fit of parameters; what is None is the session's own `[fit]`.

    Attributes
    ----------
    free, exact : tuple of str or None
    laws : tuple of str or None
        One, or several of which the held-out conditions choose.
    forward : str or None
    sessions : tuple of Path
        Further sessions that are fitted together with the first.
    file : Path or None
        A TOML file with a `[fit]` table in the place of the session's.
    discrepancy : str or None
        Of the model over depth, a share of the force.
    markers : bool or None
        Whether markers are fitted along.
    posterior : bool
        Whether to draw from the posterior.
    seed : int
        Of the draws.
    """

    free: tuple[str, ...] | None = None
    exact: tuple[str, ...] | None = None
    laws: tuple[str, ...] | None = None
    forward: str | None = None
    sessions: tuple[Path, ...] = field(default_factory=tuple)
    file: Path | None = None
    discrepancy: str | None = None
    markers: bool | None = None
    posterior: bool = False
    seed: int = 0

    def table(self, own: FitTable) -> FitTable:
        """The `[fit]` table with what was said put in; raises InputError."""
        table, source = own.model_dump(), Source("[fit]")
        if self.file is not None:
            read, source = read_toml(self.file, "fit")
            table = read.get("fit", read)
            if not isinstance(table, dict):
                raise InputError(f"{self.file}: fit = {table!r}; allowed is a table [fit]")
        law = None if self.laws is None else self.laws[0]
        said: dict[str, object] = {"free": self.free, "exact": self.exact, "law": law, "forward": self.forward}
        said |= {"discrepancy": self.discrepancy, "markers": self.markers}
        said = {key: value for key, value in said.items() if value is not None}
        for key, value in said.items():
            validated(FitTable, {key: value}, Source(f"--{key}"))
        return validated(FitTable, table | said, source)

    def check(self, session: Session) -> None:
        """Refuse laws, models and keys that there are not, before anything is computed.

        A tool's edge is left to the fit, which may give one to a tool that was told without.
        """
        for name in self.laws or ():
            law_shape(name)
        table, setup = self.table(session.fit), session.setups[0]
        if not table.free and (self.sessions or table.law is not None or self.posterior):
            raise InputError("several sessions, a law or a posterior need free parameters: give --free KEY,KEY")
        if self.posterior:
            load_emcee()
        for key in (key for key in table.free if key != EDGE_RADIUS):
            refuse_without_effect(key, session.setups)
            for law in self.laws or (table.law,):
                parameters_of(key, setup, law)
        file = session.folder / SESSION_FILE if self.file is None else self.file
        if table.free:
            self._check_told(table, session.setups, file)
        else:
            self._refuse_unused(table, file)
        if not self.sessions:  # of several, the others' layers are known later
            check_exact(table.exact, session.setups, f"{file}: [fit] exact" if self.exact is None else "--exact")

    def _refuse_unused(self, table: FitTable, file: Path) -> None:
        """Refuse what a fit is told that has no free parameters, since it would be passed over."""
        told = {
            f"{file}: [fit] per_specimen": table.per_specimen,
            f"{file}: [fit.fixed]": table.fixed,
            f"{file}: [fit.bounds]": table.bounds,
            f"{file}: [fit.priors]": table.priors,
        }
        for place, keys in told.items():
            if keys:
                needed = "give free = [...] in [fit], or --free KEY,KEY"
                raise InputError(f"{place} {next(iter(keys))}: without free parameters this is of no use; {needed}")

    def _check_told(self, table: FitTable, setups: Sequence[Setup], file: Path) -> None:
        """Refuse what a file tells of a fit that does not fit; raises InputError that names the file."""
        try:
            for key in table.fixed:
                refuse_without_effect(key, setups, "[fit.fixed]")
            for law in self.laws or (table.law,):
                check_wish(table.model_copy(update={"law": law}), setups[0])
        except InputError as error:
            raise InputError(f"{file}: {error}") from None


def answer_of(
    founds: Sequence[FittedSession], wish: ParameterWish, table: FitTable, listener: Listener
) -> ParametersAnswer:
    """Fit parameters, with each law where there are several; then the design and the posterior; raises as a fit."""
    laws = tuple(wish.laws or ())
    answers = {law: fit_parameters(founds, table.model_copy(update={"law": law}), listener) for law in laws}
    compared = scores(answers) if len(laws) > 1 else ()
    if len(laws) > 1 and not compared:
        raise InputError("laws are chosen by held-out conditions, and these trials have but one: give one --law")
    identified = answers[simplest(compared)] if compared else next(iter(answers.values()), None)
    if identified is None:
        identified = fit_parameters(founds, table, listener)
    listener.say("what to measure next")
    drawn = posterior(identified.found, wish.seed) if wish.posterior else None
    return ParametersAnswer(identified, compared, designed(identified), drawn)


def fit_parameters(founds: Sequence[FittedSession], table: FitTable, listener: Listener) -> Identified:
    """Fit what a `[fit]` table leaves free to the trials of sessions that have their first fit.

    Raises
    ------
    InputError
        Keys or values that cannot be used.
    SolverError
        The model does not follow the presses.
    """
    bases = [base for one in founds for base in _bases(one)]
    made = assembled(bases, table)
    names = [one.session.name for one in bases]
    unknown, trials = counted(len(made.problem.free), "parameter"), counted(len(made.problem.trials), "trial")
    listener.say(f"{founds[0].session.name}: fitting {unknown} to {trials}")
    start = begun(made.problem, made.touches, made.zeros)
    found, others = other_answers(fit_layers(start, listener.say), listener.say)
    groups = [_group(made, k, len(bases) > 1) for k in range(len(made.problem.trials))]
    answer = identify(found, others, directions(start), groups, names)
    return replace(answer, remarks=made.warnings)


def _group(made: Assembled, number: int, several: bool) -> str:
    """What is held out together: a condition, of one session where there are several."""
    trial = made.problem.trials[number]
    press = made.problem.presses[trial.press]
    return f"{press.session.name}: {trial.data.condition}" if several else trial.data.condition


def _bases(found: FittedSession) -> list[FittedBase]:
    """A session with its fit, one base of each height of specimen."""
    sheet = None if found.filmed is None else found.filmed.sheet
    films, view = {}, EVERYWHERE
    for key, (filmed, table) in found.sheets.items():
        own = None if sheet is None else sheet.trial(key)
        films[key], view = (filmed, (0.0, 0.0) if own is None else own.state.axis), table.view
    data = {one.key: one for one in found.trials}
    return [
        FittedBase(
            one, found.fit, [data[each.condition, each.name] for each in one.trials], found.followed, films, view
        )
        for one in found.session.by_height()
    ]


def common_factor_warnings(found: FittedSession, listener: Listener) -> tuple[str, ...]:
    """What must be said of one factor for several layers: that layers cannot be told apart, or that they differ."""
    layers = found.session.specimen.layers
    if len(layers) < 2:
        return ()
    listener.say(f"{found.session.name}: can these trials tell the {len(layers)} layers apart?")
    try:
        free = _surrogate_fit(found, tuple(f"{one.name}.{MODULUS}" for one in layers))
        common = _surrogate_fit(found, (COMMON,))
    except (InputError, SolverError) as error:
        return (f"whether the layers can be told apart was not worked out: {error}",)
    said = []
    unknown = [one for one in directions(free) if not one.known]
    if unknown:
        said.append(
            f"one factor for {len(layers)} layers: these trials cannot tell which layer differs ({unknown[0].text}); a "
            "press with another tool radius would tell more (fit --free)"
        )
    gain = 2.0 * (_misfit(common, free) - free.fit.objective)
    if gain > BETTER * (len(layers) - 1):
        said.append(
            f"the layers differ from what was told by more than one factor: free moduli follow the trials better "
            f"(-2 log likelihood falls by {gain:.0f} for {len(layers) - 1} more parameters); use --free "
            f"{','.join(f'{one.name}.{MODULUS}' for one in layers)}"
        )
    return tuple(said)


def _surrogate_fit(found: FittedSession, keys: tuple[str, ...]) -> LayerFit:
    """A fit on the surrogates of the first fit, without uncertainties of the set-up."""
    made = assembled(_bases(found), FitTable(free=keys, exact=("all",)))
    return fit_layers(begun(made.problem, made.touches, made.zeros), rounds=1)


def with_setup(found: FittedSession, exact: tuple[str, ...], listener: Listener) -> FittedSession:
    """The fit of one stiffness to force, with the interval that the uncertainty of the set-up as told leaves of it.

    Told are the tool's radius and edge, and each layer's thickness and Poisson's ratio, each with its stated or a usual
    uncertainty where it is not `exact`. By linear propagation (JCGM 100:2008, 5.1.2): each trial is fitted again with
    the force moved by its derivative.
    """
    session = found.session
    if found.filmed is not None and found.filmed.sheet is not None:
        why = "with markers no uncertainty of the set-up is worked out without --free"
        passed_over = (f"exact {', '.join(exact)} is passed over: {why}",) if exact else ()
        return replace(found, warnings=(*found.warnings, *passed_over))
    listener.say(f"{session.name}: how far may the set-up as told move the stiffness?")
    try:
        made = assembled(_bases(found), FitTable(free=(COMMON,), exact=exact))
        _, presses = followed(made.problem, made.problem.start)
        shares = _setup_shares(found, made.problem, presses)
    except (InputError, SolverError, FittingError) as error:
        said = f"how far the set-up as told may move the stiffness was not worked out: {error}"
        return replace(found, warnings=(*found.warnings, said))
    if not shares:
        return found
    wide = widened(found.fit.stiffness, shares)
    notes = (*found.fit.notes, f"the wider interval has {wide.method}")
    return replace(found, fit=replace(found.fit, with_setup=wide, notes=notes))


def _setup_shares(found: FittedSession, problem: FitProblem, presses: Sequence[PressSurrogate]) -> dict[str, float]:
    """By how much the logarithm of the stiffness goes with the uncertainty of each key of the set-up that was told."""
    told = {trial.key: trial for trial in found.trials}
    pairs = [(told[trial.data.key], presses[trial.press]) for trial in problem.trials]
    shares: dict[str, float] = {}
    for number, one in enumerate(problem.parameters):
        if one.told and one.prior is not None:
            moved = [_moved(found, trial, press, number) for trial, press in pairs]
            share = one.prior.deviation * math.fsum(moved) / len(moved)
            shares[one.key] = math.hypot(shares.get(one.key, 0.0), share)
    return shares


def _moved(found: FittedSession, trial: TrialData, press: PressSurrogate, number: int) -> float:
    """By how much the logarithm of a trial's stiffness goes down for a coordinate of its press, by its number."""
    if not press.by[number].any():
        return 0.0
    curve = trial.curve
    force = curve.force * np.exp(MOVE * np.interp(curve.depth, press.depth, press.by[number]))
    moved = fit_trial(replace(trial, curve=ForceCurve(curve.depth, np.maximum.accumulate(force))))
    return (found.fit.trial(trial.name, trial.condition).log_stiffness - moved.log_stiffness) / MOVE


def _misfit(common: LayerFit, free: LayerFit) -> float:
    """The objective of the common factor's fit with the noise and scatter that the free one found."""
    own, other = common.model, free.model
    model = replace(own, white=other.white, noise=other.noise, gain_deviation=other.gain_deviation)
    return least_squares(model, common.vector, common.fit.nuisance, search=SEARCH).objective
