"""Blind cases put to a discovery, a function of a session and a seed that is named `module:function`.

Each case is in a folder that lasts as long as its discovery; several run at a time, resumed after a stop.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, cast

from bench_hw.storage.folder_lock import scratch
from benchmark.blind.cases import CaseName
from benchmark.blind.scoring.judging import IMPOSSIBLE, Judged, failed, judge, looped, unanswered
from benchmark.blind.session_files import case
from benchmark.child_processes import PoolContext, begin_in_pool, single_threaded_children
from benchmark.discovery.discovery_result import Discovery
from benchmark.errors import InputError
from benchmark.files.sessions.trials import Session
from benchmark.resumable import Journal, read_rows
from benchmark.sweeps.cluster import on_cluster
from reports.formatting import counted

PRODUCT = "benchmark.discovery:discover"
OnCase = Callable[[int, int, Judged | None], None]


class Discoverer(Protocol):
    """Answers for a session."""

    def __call__(self, session: Session, *, seed: int) -> Discovery:
        """Find where and why the model and the session disagree."""
        ...


def load_discoverer(name: str) -> Discoverer:
    """The function of that name; the product's own gets its usual settings, the seed, and one process.

    Raises
    ------
    InputError
        It is not of the form `module:function`, or there is no such function.
    """
    found = _function(name)
    if name != PRODUCT:
        return cast(Discoverer, found)
    settings = _function("benchmark.discovery:Settings")

    def product(session: Session, *, seed: int) -> Discovery:
        return cast(Discovery, found(session, settings=settings(seed=seed, workers=1)))

    return product


def _function(name: str) -> Any:
    """What a module has under a name, if it can be called; raises InputError."""
    module, _, function = name.partition(":")
    try:
        found, reason = getattr(importlib.import_module(module), function, None), ""
    except Exception as error:  # a module of the user's may raise anything
        absent = isinstance(error, ModuleNotFoundError) and error.name == module
        found, reason = None, "" if absent else f"; {type(error).__name__}: {error}"
    if not callable(found):
        raise InputError(
            f"--discoverer {name!r}: there is no such function{reason}; allowed: module:function, as in {PRODUCT}, "
            "called with a session and a seed"
        )
    return found


def run_case(name: CaseName, discover: Discoverer, experiments: int = 0) -> Judged:
    """Make the case, let `discover` answer for its session folder, and judge the answer.

    A discovery that raises is judged as one that says nothing; its time is the discovery's, reading included. A case
    whose effect cannot be as strong as wanted in its lab is not put to it. With `experiments` the product's own
    discovery answers, and again after each of so many experiments at most; the last answer is judged.
    """
    from benchmark.files.sessions.session_loading import load_session

    with scratch() as parent:
        try:
            folder, made = case(name, parent)
        except ValueError as error:
            return unanswered(name, IMPOSSIBLE, str(error))
        started = time.perf_counter()
        try:
            if experiments:
                from benchmark.blind.closed_loop import closed_loop

                loop = closed_loop(made, folder, experiments)
                return looped(made, loop.answers, loop.experiments, time.perf_counter() - started)
            answer = discover(load_session(folder), seed=name.seed)
        except Exception as error:
            return failed(made, error, time.perf_counter() - started)
        return judge(made, answer, time.perf_counter() - started)


def run_cases(
    cases: Sequence[CaseName],
    discoverer: str,
    journal: Path,
    workers: int | str,
    on_case: OnCase,
    experiments: int = 0,
    say: Callable[[str], None] = lambda _: None,
) -> tuple[Judged, ...]:
    """Run the cases that the journal does not have yet.

    Parameters
    ----------
    cases : sequence of CaseName
    discoverer : str
        `module:function`.
    journal : Path
        Where each finished case is kept at once, a line of JSON.
    workers : int or str
        Processes; 1 is this one. Or the address of a Dask scheduler.
    on_case : callable
        Told how many of how many are finished, and the last one.
    experiments : int
        As `run_case` takes it.
    say : callable
        Told, once, how many rows of the journal were changed since they were written, which are computed again.

    Returns
    -------
    tuple of Judged
        In the order of `cases`.
    """
    changed: list[str] = []
    finished = {row.case: row for row in read_rows(journal, Judged, changed.append)}
    waiting = [name for name in cases if name.text not in finished]
    if changed and waiting:
        say(f"warning: {journal}: {counted(len(changed), 'row')} changed since written; what it held is computed again")
    on_case(len(cases) - len(waiting), len(cases), None)
    with closing(Journal(journal)) as kept:
        for row in _work([Job(name, discoverer, experiments) for name in waiting], workers):
            kept.add(row)
            finished[row.case] = row
            on_case(sum(name.text in finished for name in cases), len(cases), row)
    return tuple(finished[name.text] for name in cases)


@dataclass(frozen=True)
class Job:
    """A case, who answers for it, and how many experiments may follow."""

    name: CaseName
    discoverer: str
    experiments: int


def _work(jobs: Sequence[Job], workers: int | str) -> Iterator[Judged]:
    """Yield finished cases as they come; one worker is this process."""
    if isinstance(workers, str):
        yield from on_cluster(_done, jobs, lambda job, reason: unanswered(job.name, "error", reason), workers, _unheard)
        return
    if workers == 1 or not jobs:
        yield from (_done(job) for job in jobs)
        return
    size = min(workers, len(jobs))
    with single_threaded_children(), ProcessPoolExecutor(size, PoolContext(), initializer=begin_in_pool) as pool:
        futures = [pool.submit(_done, job) for job in jobs]
        try:
            for future in as_completed(futures):
                yield future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _unheard(_: str) -> None:
    """Remarks on the cluster go nowhere."""


def _done(job: Job) -> Judged:
    return run_case(job.name, load_discoverer(job.discoverer), job.experiments)
