"""The whole way: a session to what its model lacks."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from benchmark.discovery import criteria
from benchmark.discovery.answer.estimates import (
    base_estimates,
    candidates,
    named_effects,
    own_gain,
    remains,
    setup_estimates,
)
from benchmark.discovery.answer.gap import (
    HeldOut,
    closed_overall,
    gaps,
    grows,
    held_out_residuals,
    share_left,
    shrinks,
    traces,
    unbent,
    worse,
)
from benchmark.discovery.answer.verdict import Facts, statement, verdict
from benchmark.discovery.base.calibration import Calibrated, calibrate
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.base.setup_priors import setup_entries, told_priors
from benchmark.discovery.base.trial_bounds import gains_between, large_remarks, late_by_speed, trial_values
from benchmark.discovery.base.trials_problem import OWN
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.cells import channel_sizes, misses_nothing, reachable, within_tolerance
from benchmark.discovery.detection.contrasts import contrasts
from benchmark.discovery.detection.disagreement import (
    Detection,
    combined,
    detect,
    exchangeable,
    nothing_amiss,
    shared_by_chance,
    shared_misfit,
    smallest_visible,
    strained,
)
from benchmark.discovery.detection.places import places, shared_places
from benchmark.discovery.discovery_result import Discovery, Place
from benchmark.discovery.evidence.gains import conditions, tissue_gain
from benchmark.discovery.evidence.parameter_evidence import (
    at_bounds,
    constant,
    moved_far,
    told_together,
    undetermined,
    unsteady,
)
from benchmark.discovery.evidence.pool import Listener, Pool, fingerprint, own_code, pool, silent
from benchmark.discovery.evidence.selection import Selection, first_gain, ruled_out, select, unchosen, usable
from benchmark.discovery.evidence.shortlist import (
    compared,
    not_shown,
    on_all,
    on_some,
    promising,
    remark,
    screen,
    unseen,
)
from benchmark.discovery.evidence.told_setup import on_told, setup_first, stands, taken_up
from benchmark.discovery.trials.preparing import prepare
from benchmark.files import Session
from benchmark.physics import Effect, catalogue
from benchmark.physics.setup_entry import setup_key
from benchmark.response.elastic_table import TableOf
from benchmark.resumable import code_version

DEFAULT = Settings()
MOST_CONFIDENCE = {"outside_catalogue": 0.0, "partly_explained": 0.5, "instrument_first": 0.5}
"""Of an effect that is not named, and of one beside which something is missing or in question that it may stand for."""
VERSION = 4
"""Of the method: fits kept by another are done anew."""


@dataclass(frozen=True, eq=False)
class Findings:
    """The answer with the fits behind it.

    Attributes
    ----------
    discovery : Discovery
        Plain results.
    calibrated : Calibrated
        The base's fit, with noise and priors.
    searched : Searched
        The base that was taken, the chosen fit, its look-alikes and their fits.
    known : tuple of Effect
        Candidates: entries of the session's set-up, the catalogue, and own ones.
    settings : Settings
    chosen : Fit or None
        The answer fitted to all trials.
    """

    discovery: Discovery
    calibrated: Calibrated
    searched: Searched
    known: tuple[Effect, ...]
    settings: Settings
    chosen: Fit | None = None

    @property
    def selection(self) -> Selection:
        """What was chosen, with its look-alikes."""
        return self.searched.selection


def discover(
    session: Session,
    *,
    settings: Settings = DEFAULT,
    effects: Sequence[Effect] = (),
    listener: Listener = silent,
    store: Path | None = None,
) -> Discovery:
    """Find what the model of a session lacks; see `findings`."""
    return findings(session, settings=settings, effects=effects, listener=listener, store=store).discovery


def findings(
    session: Session,
    *,
    settings: Settings = DEFAULT,
    effects: Sequence[Effect] = (),
    listener: Listener = silent,
    store: Path | None = None,
    table_of: TableOf | None = None,
    without: AbstractSet[str] = frozenset(),
) -> Findings:
    """Find what the model of a session lacks, and keep the fits.

    Linear algebra has one thread here: its products are small, and beside another program threads that wait for each
    other took up to a hundred times as long as one.

    Parameters
    ----------
    session, settings
        Measured trials, and choices that are the same for all sessions unless a user says otherwise.
    effects
        Own effects beside the catalogue (`benchmark.physics.load_effects`).
    listener
        Told of stage, done, total and the best candidate so far.
    store
        Folder for fits as they come, from which an interrupted discovery goes on.
    table_of
        The elastic base of a set-up; by default the finite elements', or the wave's where they do not cover it.
    without
        Slugs of effects that other measurements have ruled out.

    Raises
    ------
    InputError
        The session cannot be used: too few trials, no motion, no force, or mixed protocols.
    """
    began = time.perf_counter()
    listener("prepare", 0, 1, "")
    with threadpool_limits(1):
        calibrated = calibrate(session, prepare(session, settings.rows), table_of)
        entries = setup_entries(calibrated.problem.tables)
        known = tuple(each for each in (*entries, *catalogue(), *effects) if each.slug not in without)
        own = [own_code(each) for each in effects]
        key = fingerprint(VERSION, code_version(), session.fingerprint, settings, own, *sorted(without))
        listener("detect", 0, 1, "")
        with pool(settings.workers, store, key, effects, listener) as work:
            searched = _answered(calibrated.base, told_priors(session), known, settings, work)
        calibrated = replace(calibrated, warnings=(*calibrated.warnings, *searched.remarks))
        listener("verify", 0, 1, "")
        return _finished(calibrated, searched, known, settings, began)


def without_ruled_out(found: Findings, lost: AbstractSet[str]) -> Findings:
    """The answer once a measurement apart from the trials has ruled out effects: of what stood, the nearest left.

    The trials are not searched anew. They told no more than which causes may stand behind them, and a base that moves
    would take up the one that is left.
    """
    began = time.perf_counter()
    with threadpool_limits(1):
        searched = replace(found.searched, selection=ruled_out(found.selection, lost))
        known = tuple(each for each in found.known if each.slug not in lost)
        return _finished(found.calibrated, searched, known, found.settings, began)


def _finished(
    calibrated: Calibrated, searched: Searched, known: tuple[Effect, ...], settings: Settings, began: float
) -> Findings:
    answer = _verified(searched, settings)
    discovery = _discovery(calibrated, answer, known, settings, began)
    return Findings(discovery, calibrated, searched, known, settings, answer.chosen)


@dataclass(frozen=True, eq=False)
class Searched:
    """What the search ends with.

    Attributes
    ----------
    base : Fit
        That is taken.
    selection : Selection
    before : Detection
    told : Fit
        The base whose misfit counts: with the set-up as told where what was found on it is taken up by another.
    remarks : tuple of str
    """

    base: Fit
    selection: Selection
    before: Detection
    told: Fit
    remarks: tuple[str, ...] = ()

    @property
    def taken_up(self) -> bool:
        """Whether another set-up has taken up what the set-up as told would need."""
        return self.told is not self.base


def _answered(
    moving: Fit, told: Mapping[str, float], known: Sequence[Effect], settings: Settings, work: Pool
) -> Searched:
    """What was found on the set-up as told where that stands, else on another."""
    trusted = on_told(moving, told)
    selection, before = _searched(trusted, known, settings, work)
    if trusted is not moving:
        silent_on_it = before.p < settings.level and not selection.steps
        if silent_on_it or not stands(selection.chosen, selection.base, on_some(moving, compared(moving)), known, work):
            found, seen = _searched(moving, known, settings, work)
            if found.steps or not setup_first(selection):
                gone = bool(selection.steps) and not found.steps
                return Searched(moving, found, seen, trusted if gone else moving, taken_up(selection, found))
    return Searched(trusted, selection, before, trusted)


def _searched(base: Fit, known: Sequence[Effect], settings: Settings, work: Pool) -> tuple[Selection, Detection]:
    """The effects that were chosen, and whether there is a disagreement at all."""
    screened = screen(base, [effect for effect in known if usable(base, effect)])
    before = detect(base, settings, np.vstack([one.along for one in screened]))
    some = on_some(base, compared(base))
    able = reachable(conditions(base), settings)
    searched = known if able and (before.p < settings.level or promising(base, screened)) else ()
    selection = select(some, searched, settings, work, screened if some is base else ())
    return selection, replace(before, p=min(before.p, combined(1.0, 1.0, first_gain(selection))))


@dataclass(frozen=True, eq=False)
class _Answer:
    """The chosen effects on all trials: fitted, tested again, and predicting what the fit has not seen.

    Attributes
    ----------
    searched : Searched
    chosen : Fit
        Of all trials; the base where nothing was chosen.
    plain : Fit
        Without effects, unbent: the "before" of pictures, places and gap.
    after : Detection
        With the effects.
    held : HeldOut
    left : float
        Share of the misfit that trials share which the effects leave.
    """

    searched: Searched
    chosen: Fit
    plain: Fit
    after: Detection
    held: HeldOut
    left: float

    @property
    def base(self) -> Fit:
        """Of all trials, without effects."""
        return self.searched.base

    @property
    def selection(self) -> Selection:
        """What was chosen, with its look-alikes."""
        return self.searched.selection

    @property
    def before(self) -> Detection:
        """The test without effects."""
        return self.searched.before


def _verified(searched: Searched, settings: Settings) -> _Answer:
    base, before = searched.base, searched.before
    chosen = on_all(base, searched.selection.chosen)
    if chosen is base:
        return _Answer(searched, base, base, before, held_out_residuals(base, base), 0.0)
    plain = unbent(base, chosen)
    if misses_nothing(plain) and not any(setup_key(effect.slug) for effect in chosen.model.effects):
        return _verified(replace(searched, selection=unchosen(searched.selection)), settings)
    after = detect(chosen, settings)
    held = held_out_residuals(plain, chosen)
    return _Answer(searched, chosen, plain, after, held, share_left(plain, chosen))


def _discovery(
    calibrated: Calibrated, answer: _Answer, known: Sequence[Effect], settings: Settings, began: float
) -> Discovery:
    """The answer in plain results; `began` is when the clock started, s."""
    base, chosen, before = answer.base, answer.chosen, answer.before
    gap = gaps(base, answer.held, settings)
    facts = replace(
        _facts(answer, known, settings),
        grows=grows(base, answer.held, gap, settings),
        shrinks=shrinks(base, answer.held, settings),
    )
    word = verdict(facts)
    untested = not facts.enough
    nothing = word in ("cannot_tell", "no_discrepancy")
    problem, slugs = base.model.problem, tuple(effect.slug for effect in chosen.model.effects)
    closed = {slugs: closed_overall(base, answer.held)} if slugs else {}
    beside = () if nothing else (*moved_far(chosen), *at_bounds(chosen), *told_together(chosen))
    large = (*large_remarks(problem, chosen.nuisance), *beside)
    few = remark(len(answer.selection.base.model.problem.trials), len(problem.trials))
    return Discovery(
        verdict=word,
        statement=statement(word, facts),
        p=None if untested else before.p_cells if nothing else facts.p_any,
        effects=() if nothing else named_effects(answer.selection, MOST_CONFIDENCE.get(word, 1.0)),
        where=() if untested else _where(answer, facts, settings, nothing=nothing),
        contrasts=contrasts(base, before, settings),
        gap=gap,
        smallest_visible={} if untested else smallest_visible(base, before),
        candidates=candidates(answer.selection, closed),
        base=base_estimates(chosen),
        remains=() if nothing else remains(chosen, answer.after, settings.level),
        warnings=(*problem.study.warnings, *calibrated.warnings, *exchangeable(before), *few, *large),
        traces=traces(base, answer.held),
        conditions=tuple(each.name for each in problem.study.conditions),
        channels=tuple(dict.fromkeys(problem.study.channels)),
        trials=tuple(trial.name for trial in problem.trials),
        seconds=time.perf_counter() - began,
        sizes=channel_sizes(*((answer.searched.told,) * 2 if nothing else (answer.plain, chosen))),
        not_shown=not_shown(problem.study, known),
        worse=() if nothing else facts.worse,
        undetermined=() if nothing else facts.undetermined,
        setup=setup_estimates(chosen),
        own=trial_values(problem, chosen.nuisance),
    )


def _facts(answer: _Answer, known: Sequence[Effect], settings: Settings) -> Facts:
    """What the verdict rests on."""
    selection, by_slug = answer.selection, {effect.slug: effect for effect in known}
    problem = answer.chosen.model.problem
    alike = {slug for slugs in selection.lookalikes.values() for slug in slugs}
    return Facts(
        p=answer.before.p,
        p_cells=answer.before.p_cells,
        enough=reachable(conditions(answer.base), settings),
        effects=tuple(sorted(selection.chosen.model.effects, key=lambda each: -own_gain(selection, each.slug))),
        lookalikes=tuple(by_slug[slug] for slug in sorted(alike)),
        left=_left(answer),
        p_after=answer.after.p,
        transfers=constant(answer.chosen),
        level=settings.level,
        within=within_tolerance(answer.searched.told),
        fitted=within_tolerance(answer.chosen),
        tiny=nothing_amiss(answer.searched.told),
        taken_up=answer.searched.taken_up,
        worse=() if answer.chosen is answer.base else worse(answer.base, answer.held),
        conditions=len(answer.base.model.problem.study.conditions),
        undetermined=undetermined(answer.chosen),
        unsteady=unsteady(answer.chosen),
        p_strained=strained(answer.chosen, criteria.TIE * tissue_gain(selection.chosen, selection.own)),
        shared=shared_misfit(answer.chosen),
        p_shared=shared_by_chance(answer.chosen, settings),
        by_speed=late_by_speed(problem, answer.chosen.nuisance[:, OWN.index("shift")]) is not None,
        parted=gains_between(problem, answer.chosen.nuisance[:, OWN.index("gain")]) is not None,
        unseen=unseen(problem.study, known),
    )


def _where(answer: _Answer, facts: Facts, settings: Settings, *, nothing: bool) -> tuple[Place, ...]:
    """Where they disagree; in the phases that trials share row by row where no cell shows it."""
    base = answer.base
    if facts.by_rows and not (nothing or facts.effects or facts.by_cells):
        return shared_places(base, settings)
    before, chosen = (base, base) if nothing else (answer.plain, answer.chosen)
    return places(base, before, chosen, answer.before, settings)


def _left(answer: _Answer) -> float:
    """Share that the effects leave: what a withheld one would take is no unknown cause, if little is left beside it."""
    beside = [answer.left * share_left(each.under, each.fit) for each in answer.selection.withheld]
    return min(answer.left, criteria.OUTSIDE) if min(beside, default=1.0) <= criteria.OUTSIDE else answer.left
