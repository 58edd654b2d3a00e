"""From what `discover` was asked for to its result folder: a session, or one or two finished runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from benchmark.discovery.evidence.pool import forget
from benchmark.discovery.from_run import at_small_strain, is_run, read_run, repair_run
from benchmark.discovery.report.discovery_files import DiscoveryOutcome, write_discovery
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.errors import InputError
from benchmark.physics import Effect, catalogue, load_effects
from benchmark.runs.destination import destination
from benchmark.runs.listener import Listener


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


OfSession = Callable[[DiscoverRequest, tuple[Effect, ...], Listener], DiscoveryRecord]


def carry_out(request: DiscoverRequest, of_session: OfSession, listener: Listener) -> DiscoveryOutcome:
    """Answer for a session or for finished runs, and write the result folder.

    Parameters
    ----------
    request
        What was asked for.
    of_session
        What answers for a session.
    listener
        Told of progress.

    Raises
    ------
    InputError
        Unusable input, or options that do not go together; nothing is written then.
    """
    destination(request.out, "", (*request.paths, request.effects, request.specimen, *request.settings.values()))
    effects = (*catalogue(), *(() if request.effects is None else load_effects(request.effects)))
    if any(is_run(path) for path in request.paths):
        record = _of_runs(request, effects, listener)
    elif len(request.paths) > 1:
        raise InputError(
            "discover takes one session (several conditions belong into one), or one or two result folders of run"
        )
    else:
        record = of_session(request, effects, listener)
    outcome = write_discovery(record, destination(request.out, f"{record.name}-discovery"))
    if record.store is not None:
        forget(record.store)
    return outcome


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
