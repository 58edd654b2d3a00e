"""A session's discovery with its origin, resumable, its progress told."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from benchmark.discovery.carrying_out import DiscoverRequest
from benchmark.discovery.criteria import Settings
from benchmark.discovery.planning.proposing import propose
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.discovery.workflow import Findings, findings
from benchmark.files import Session, load_session
from benchmark.physics import SLUGS, Effect
from benchmark.response.fem_table import fem_table
from benchmark.runs.destination import file_name
from benchmark.runs.listener import Listener

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
    loaded = load_session(request.paths[0], request.settings, request.specimen)
    session, said = _with_films(loaded, listener)
    own = tuple(effect for effect in effects if effect.slug not in SLUGS)
    store = store_folder(request.out, session, request.model)
    found = _found(session, request, own, listener, store)
    warnings = tuple(dict.fromkeys((*session.warnings, *said, *found.discovery.warnings)))
    return DiscoveryRecord(
        name=session.name,
        source="session",
        fingerprint=session.fingerprint,
        synthetic=session.synthetic,
        tissue=session.specimen.name,
        model=request.model,
        found=replace(found.discovery, warnings=warnings),
        cards={effect.slug: (effect.richer or effect).description for effect in effects},
        seed=request.seed,
        proposal=propose(found),
        large_press="corrected",
        store=store,
    )


def _with_films(session: Session, listener: Listener) -> tuple[Session, tuple[str, ...]]:
    if session.camera is None:
        return session, ()
    from benchmark.runs.filming import with_markers

    return with_markers(session, listener)


def store_folder(out: Path | None, session: Session, model: str) -> Path:
    """Where the fits of an unfinished discovery are kept: beside the result, the same for the same session."""
    if out is not None:
        return out.parent / f".{out.name}-{model}.unfinished"
    return Path("results") / f".{file_name(session.name)}-{session.fingerprint[:12]}-{model}.unfinished"


def _found(
    session: Session, request: DiscoverRequest, own: tuple[Effect, ...], listener: Listener, store: Path
) -> Findings:
    table_of = fem_table(session) if request.model == "fem" else None
    settings = Settings(seed=request.seed)
    with listener.progress(f"{session.name}: what the model lacks") as advance:

        def on_stage(stage: str, done: int, total: int, best: str) -> None:
            remark = f"best so far {best.replace('_', ' ')}" if best else ""
            advance(STAGES.get(stage, stage), done, max(total, 1), remark)

        return findings(session, settings=settings, effects=own, listener=on_stage, store=store, table_of=table_of)
