"""From what `discover` was asked for to its result folder: a session, or one or two finished runs.

A session's fits are kept beside the result until it is complete, so that an interrupted discovery goes on.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from benchmark.discovery.base.setup_priors import table_keys, told_priors
from benchmark.discovery.criteria import Settings
from benchmark.discovery.evidence.pool import forget
from benchmark.discovery.evidence.told_setup import on_told
from benchmark.discovery.from_run import at_small_strain, is_run, read_run, repair_run
from benchmark.discovery.planning.bench_loop import Loop
from benchmark.discovery.planning.bench_work import (
    Asked,
    BenchWork,
    kept_experiments,
    load_bench,
    recorded,
    session_copy,
    unattended,
)
from benchmark.discovery.planning.proposing import Allowed, propose
from benchmark.discovery.refitting.refit import picked, refits
from benchmark.discovery.refitting.refit_result import ModelRefit
from benchmark.discovery.report.discovery_files import DiscoveryOutcome, write_discovery
from benchmark.discovery.report.discovery_record import NAMING, DiscoveryRecord, NextExperiment, Round
from benchmark.discovery.workflow import DEFAULT, Findings, findings
from benchmark.errors import InputError, TissuebenchError
from benchmark.files import Session, load_session
from benchmark.files.schema import nearest
from benchmark.files.shipped import session_folder
from benchmark.physics import SLUGS, Effect, catalogue, load_effects
from benchmark.response.fem_table import fem_or_wave_table, fem_table
from benchmark.runs.options import Listener
from benchmark.runs.output.destination import claimed, destination, file_name
from benchmark.sessions import HIDDEN_EFFECT, SHIPPED
from reports.result_folder import KeptElsewhereError


@dataclass(frozen=True)
class DiscoverRequest:
    """What the command line asked for; see `python -m benchmark discover --help`."""

    paths: Sequence[Path]
    model: str = "wave"
    effects: Path | None = None
    specimen: str | None = None
    settings: Mapping[str, str] = field(default_factory=dict)
    out: Path | None = None
    seed: int = 0
    bench: str | None = None
    budget: int = 3
    asked: Asked = unattended
    refit: str | None = None


def carry_out(request: DiscoverRequest, listener: Listener) -> DiscoveryOutcome:
    """Answer for a session or for finished runs, and write the result folder, whose place is checked first.

    Raises
    ------
    InputError
        As `answer` and `destination`; nothing is written then.
    """
    inputs = (*request.paths, request.effects, request.specimen, *request.settings.values())
    with claimed(request.out, "discover"):
        destination(request.out, "", inputs)
        return put_down(answer(request, listener), request.out)


def discover_shipped(out: Path | None, seed: int, listener: Listener) -> DiscoveryOutcome:
    """Answer for the shipped session in which an effect is hidden, into a folder of its name in `out`."""
    folder = None if out is None else out / HIDDEN_EFFECT
    return carry_out(DiscoverRequest([SHIPPED / HIDDEN_EFFECT], out=folder, seed=seed), listener)


def answer(request: DiscoverRequest, listener: Listener) -> DiscoveryRecord:
    """Answer for a session or for finished runs.

    Raises
    ------
    InputError
        Unusable input, or options that do not go together.
    """
    effects = (*catalogue(), *(() if request.effects is None else load_effects(request.effects)))
    if any(is_run(path) for path in request.paths):
        return _of_runs(request, effects, listener)
    if len(request.paths) != 1:
        raise InputError(
            "discover takes one session (several conditions belong into one), or one or two result folders of run"
        )
    return answer_session(request, effects, listener)


def put_down(record: DiscoveryRecord, out: Path | None) -> DiscoveryOutcome:
    """Write the result folder of an answer, by default results/NAME-DATE-TIME, and forget the fits kept for it."""
    try:
        outcome = write_discovery(record, out or destination(None, f"{record.name}-discovery"))
    except KeptElsewhereError:
        _forget(record)
        raise
    _forget(record)
    return outcome


def _forget(record: DiscoveryRecord) -> None:
    """Remove what was kept for an answer: the session that grew, and the fits."""
    if record.grown is not None:
        shutil.rmtree(record.grown, ignore_errors=True)
    if record.store is not None:
        forget(record.store)


def _of_runs(request: DiscoverRequest, effects: tuple[Effect, ...], listener: Listener) -> DiscoveryRecord:
    """The wave model of a run against its finite elements."""
    odd = [path for path in request.paths if not is_run(path)]
    if odd or len(request.paths) > 2:
        what = f"{odd[0]} is none" if odd else f"there are {len(request.paths)}"
        raise InputError(f"with a result folder of run, discover takes one or two of them and nothing else; {what}")
    if request.model != "wave":
        raise InputError("--model fem: in a finished run the FEM is what the wave model is held against; leave it out")
    if request.settings or request.specimen is not None:
        raise InputError("--set and --specimen belong to a session: a finished run has its scenario in it")
    runs = [at_small_strain(read_run(path)) for path in request.paths]
    return repair_run(runs[0], runs[1] if len(runs) > 1 else None, effects, request.seed, listener)


FOUND = "found"
"""Of `--refit`: the effects that the discovery accepted."""
STAGES = {
    "prepare": "read and align the trials",
    "detect": "is there a disagreement",
    "verify": "what the effect closes",
}


def answer_session(request: DiscoverRequest, effects: tuple[Effect, ...], listener: Listener) -> DiscoveryRecord:
    """Find what the model of a session lacks.

    Fits are kept beside the result folder until it is complete, so that an interrupted discovery goes on.

    Raises
    ------
    InputError
        The session cannot be used.
    """
    session, said = _loaded(request, request.paths[0], listener)
    store = store_folder(request.out, session, request.model)
    with claimed(store if request.out is None else None, "discover"):  # two of one session would share the kept fits
        return _answered(request, effects, listener, store, (session, said))


def _answered(
    request: DiscoverRequest,
    effects: tuple[Effect, ...],
    listener: Listener,
    store: Path,
    loaded: tuple[Session, tuple[str, ...]],
) -> DiscoveryRecord:
    """The answer for a session as it was loaded, fits being kept in `store`."""
    session, said = loaded
    own = tuple(effect for effect in effects if effect.slug not in SLUGS)
    rounds: tuple[Round, ...] = ()
    grown: Path | None = None
    stopped: TissuebenchError | None = None
    if request.bench is None:
        found = _found(session, request, own, listener, store)
        proposal = propose(found, fem_or_wave_table(session, ()), workers=DEFAULT.workers)
    else:
        loop = _looped(request, own, listener, store)
        found, grown = _run(loop, request, listener), loop.bench.folder
        rounds, stopped = tuple(loop.rounds), loop.stopped
        session, said = _loaded(request, grown, listener)
        proposal = loop.propose(found, loop.bench.allowed({each.choice for each in rounds}))
    refitted = _refitted(session, request, found, effects, listener)
    said += () if stopped is None else (f"{stopped}: the answer is that of the trials before",)
    warnings = tuple(dict.fromkeys((*session.warnings, *said, *found.discovery.warnings)))
    return DiscoveryRecord(
        name=session.name,
        source="session",
        fingerprint=session.fingerprint,
        synthetic=session.synthetic,
        tissue=session.specimen.name,
        model=request.model,
        found=replace(found.discovery, warnings=warnings),
        cards={effect.slug: effect.forms[-1].description for effect in (*found.known, *effects)},
        seed=request.seed,
        proposal=proposal,
        large_press="corrected",
        store=store,
        rounds=rounds,
        grown=grown,
        stopped=stopped,
        refits=refitted,
    )


def _refitted(
    session: Session, request: DiscoverRequest, found: Findings, effects: Sequence[Effect], listener: Listener
) -> tuple[ModelRefit, ...]:
    """The accepted effects, or those that a person picks, in the FEM and the wave model; nothing where not asked for.

    Raises
    ------
    InputError
        A slug that is no effect.
    """
    if request.refit is None or found.chosen is None:
        return ()
    if request.refit == FOUND:
        named = bool(found.discovery.effects) and found.discovery.verdict in NAMING
        listener.say(f"{session.name}: " + ("refitting in FEM and wave" if named else "no effect to refit was found"))
        return refits(session, found.chosen) if named else ()
    known = {effect.slug: effect for effect in (*found.known, *effects)}
    slugs = [slug.strip() for slug in request.refit.split(",") if slug.strip()]
    for slug in slugs:
        if slug not in known:
            raise InputError(f"--refit {request.refit}: {slug!r} is no effect; {nearest(slug, sorted(known))}")
    listener.say(f"{session.name}: refitting {', '.join(slugs)} in FEM and wave")
    base = on_told(found.calibrated.base, told_priors(session))
    return refits(session, picked(base, [known[slug] for slug in slugs]))


def _loaded(request: DiscoverRequest, path: Path, listener: Listener) -> tuple[Session, tuple[str, ...]]:
    """A session with the markers of its films, and what tracking them said."""
    session = load_session(path, request.settings, request.specimen)
    for line in session.shown:
        listener.say(line)
    return _with_films(session, listener)


def _looped(request: DiscoverRequest, own: tuple[Effect, ...], listener: Listener, store: Path) -> Loop:
    """The closed loop on a copy of the session beside the fits that are kept."""
    rig, original = load_bench(str(request.bench)), session_folder(request.paths[0])
    left = kept_experiments(original, store / "session")
    if left is not None:
        listener.say(f"{left}: what the bench recorded for a loop that was interrupted, with its session")
    folder = session_copy(original, store / "session")
    bench = BenchWork(rig, folder, request.asked, request.seed)

    def decide(path: Path, without: frozenset[str]) -> Findings:
        session, _ = _loaded(request, path, listener)
        return _found(session, request, own, listener, store, without)

    def proposed(found: Findings, allowed: Allowed) -> NextExperiment | None:
        session, _ = _loaded(request, folder, listener)
        return propose(found, fem_or_wave_table(session, ()), allowed, DEFAULT.workers)

    return Loop(bench, request.budget, decide, proposed)


def _run(loop: Loop, request: DiscoverRequest, listener: Listener) -> Findings:
    """The loop's answer; where it is cut short, as by Ctrl-C, what says where its recordings are."""
    try:
        return loop.run()
    except BaseException:
        if recorded(session_folder(request.paths[0]), loop.bench.folder):
            listener.say(
                f"{loop.bench.folder}: what the bench has recorded, with the session; the same command moves it beside "
                "the result, a session of its own, and measures anew"
            )
        raise


def _with_films(session: Session, listener: Listener) -> tuple[Session, tuple[str, ...]]:
    if session.camera is None:
        return session, ()
    from benchmark.runs.trials.filming import with_markers

    return with_markers(session, listener)


def store_folder(out: Path | None, session: Session, model: str) -> Path:
    """Where the fits of an unfinished discovery are kept: beside the result, the same for the same session."""
    if out is not None:
        return out.parent / f".{out.name}-{model}.unfinished"
    return Path("results") / f".{file_name(session.name)}-{session.fingerprint[:12]}-{model}.unfinished"


def _found(
    session: Session,
    request: DiscoverRequest,
    own: tuple[Effect, ...],
    listener: Listener,
    store: Path,
    without: frozenset[str] = frozenset(),
) -> Findings:
    table_of = fem_table(session, table_keys(session)) if request.model == "fem" else None
    settings = Settings(seed=request.seed)
    with listener.progress(f"{session.name}: what the model lacks") as advance:

        def on_stage(stage: str, done: int, total: int, best: str) -> None:
            remark = f"best so far {best.replace('_', ' ')}" if best else ""
            advance(STAGES.get(stage, stage), done, max(total, 1), remark)

        return findings(
            session,
            settings=settings,
            effects=own,
            listener=on_stage,
            store=store,
            table_of=table_of,
            without=without,
        )
