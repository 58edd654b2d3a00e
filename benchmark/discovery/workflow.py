"""The whole way: a session to what its model lacks."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmark.discovery.answer.estimates import base_estimates, candidates, named_effects, remains, transfers
from benchmark.discovery.answer.gap import HeldOut, closed_overall, gaps, held_out_residuals, share_left, traces, unbent
from benchmark.discovery.answer.verdict import Facts, statement, verdict
from benchmark.discovery.base.calibration import Calibrated, calibrate
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.contrasts import contrasts
from benchmark.discovery.detection.disagreement import Detection, combined, detect, places, smallest_visible
from benchmark.discovery.detection.places import places_of
from benchmark.discovery.discovery_result import Discovery, Place
from benchmark.discovery.evidence.pool import Listener, fingerprint, pool, silent
from benchmark.discovery.evidence.selection import Selection, first_gain, select, usable
from benchmark.discovery.evidence.shortlist import compared, on_all, on_some, remark, screen
from benchmark.discovery.trials.preparing import ENOUGH_TRIALS, prepare
from benchmark.files import Session
from benchmark.physics import Effect, catalogue
from benchmark.response.elastic_table import TableOf

DEFAULT = Settings()
VERSION = 2
SURE = 15.0
"""Effects are searched for, whatever the test says, where one step towards one gains so much log density."""


@dataclass(frozen=True, eq=False)
class Findings:
    """The answer with the fits behind it.

    Attributes
    ----------
    discovery : Discovery
        Plain results.
    calibrated : Calibrated
        The base's fit, with noise and priors.
    selection : Selection
        The chosen fit, its look-alikes and their fits.
    """

    discovery: Discovery
    calibrated: Calibrated
    selection: Selection


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
) -> Findings:
    """Find what the model of a session lacks, and keep the fits.

    Parameters
    ----------
    session
        Measured trials.
    settings
        The same for all sessions unless a user says otherwise.
    effects
        Own effects beside the catalogue (`benchmark.physics.load_effects`).
    listener
        Told of stage, done, total and the best candidate so far.
    store
        Folder for fits as they come, from which an interrupted discovery goes on.
    table_of
        The elastic base of a set-up; by default the finite elements', or the wave's where they do not cover it.

    Raises
    ------
    InputError
        The session cannot be used: too few trials, no motion, no force, or mixed protocols.
    """
    began = time.perf_counter()
    listener("prepare", 0, 1, "")
    study = prepare(session, settings.rows)
    calibrated = calibrate(session, study, table_of)
    base = calibrated.base
    listener("detect", 0, 1, "")
    known = (*catalogue(), *effects)
    screened = screen(base, [effect for effect in known if usable(base, effect)])
    before = detect(base, settings, np.vstack([one.along for one in screened]))
    key = fingerprint(VERSION, session.fingerprint, settings, [each.description for each in effects])
    with pool(settings.workers, store, key, effects, listener) as work:
        some = on_some(base, compared(base))
        searched = known if before.p < settings.level or screened[0].won > SURE else ()
        selection = select(some, searched, settings, work, screened if some is base else ())
    before = replace(before, p=min(before.p, combined(1.0, 1.0, first_gain(selection))))
    listener("verify", 0, 1, "")
    chosen = on_all(base, selection.chosen)
    after = detect(chosen, settings) if chosen is not base else before
    plain = unbent(chosen) if chosen is not base else base
    held = held_out_residuals(plain, chosen)
    left = share_left(plain, chosen) if chosen is not base else 0.0
    discovery = _discovery(session, settings, calibrated, selection, chosen, (before, after), left, held, known, began)
    return Findings(discovery, calibrated, selection)


def _discovery(
    session: Session,
    settings: Settings,
    calibrated: Calibrated,
    selection: Selection,
    chosen: Fit,
    detections: tuple[Detection, Detection],
    left: float,
    held: HeldOut,
    known: Sequence[Effect],
    began: float,
) -> Discovery:
    base = calibrated.base
    before, after = detections
    facts = _facts(selection, before, after, left, known, settings)
    word = verdict(facts)
    problem = base.model.problem
    study = problem.study
    few = remark(len(selection.base.model.problem.trials), len(problem.trials))
    overall = closed_overall(base, held)
    slugs = tuple(effect.slug for effect in chosen.model.effects)
    silent_answer = word == "no_discrepancy"
    shown = places(base, before, settings.level)
    if chosen is not base and not silent_answer:
        shown = _joined(places_of(chosen, settings), shown)
    return Discovery(
        verdict=word,
        statement=statement(word, facts),
        p=before.p_cells if silent_answer else before.p,
        effects=() if silent_answer else named_effects(selection),
        where=shown,
        contrasts=contrasts(base, before, settings),
        gap=gaps(base, held, settings),
        smallest_visible=smallest_visible(base, before),
        candidates=candidates(selection, {slugs: overall} if slugs else {}),
        base=base_estimates(chosen),
        remains=remains(chosen, after, settings.level) if not silent_answer else (),
        warnings=(*study.warnings, *calibrated.warnings, *_remarks(before), *few),
        traces=traces(base, held),
        conditions=session.conditions,
        channels=tuple(dict.fromkeys(study.channels)),
        trials=tuple(trial.name for trial in problem.trials),
        seconds=time.perf_counter() - began,
    )


def _joined(first: tuple[Place, ...], then: tuple[Place, ...]) -> tuple[Place, ...]:
    """Places of both, those of a channel and phase that the first has not dropped from the second."""
    have = {(place.channel, place.phase) for place in first}
    return (*first, *(place for place in then if (place.channel, place.phase) not in have))


def _facts(
    selection: Selection,
    before: Detection,
    after: Detection,
    left: float,
    known: Sequence[Effect],
    settings: Settings,
) -> Facts:
    by_slug = {effect.slug: effect for effect in known}
    chosen = selection.chosen.model.effects
    alike = {slug for slugs in selection.lookalikes.values() for slug in slugs}
    return Facts(
        p=before.p,
        p_cells=before.p_cells,
        enough=len(selection.base.model.problem.trials) >= ENOUGH_TRIALS,
        effects=tuple(chosen),
        lookalikes=tuple(by_slug[slug] for slug in sorted(alike)),
        left=left,
        p_after=after.p,
        transfers=transfers(selection),
        level=settings.level,
    )


def _remarks(before: Detection) -> tuple[str, ...]:
    """Whether the trials can be exchanged."""
    if before.trend.size and abs(before.trend).max() > 6.0:
        return (
            "residuals change with the trial number: the trials are not exchangeable (softening, set or drift from "
            "trial to trial)",
        )
    return ()
