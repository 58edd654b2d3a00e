"""Blind cases, each in a folder that lasts as long as its discovery, several at a time, resumed after a stop."""

from __future__ import annotations

import multiprocessing
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import closing
from pathlib import Path

from benchmark.blind.cases import CaseName
from benchmark.blind.discoverer import Discoverer, load_discoverer
from benchmark.blind.judging import Judged, failed, judge
from benchmark.blind.session_files import case
from benchmark.children import end_with_parent
from benchmark.side_by_side import single_threaded_children
from benchmark.sweep.journal import Journal, read_rows

OnCase = Callable[[int, int, Judged | None], None]


def run_case(name: CaseName, discover: Discoverer) -> Judged:
    """Make the case, let `discover` answer for its session folder, and judge the answer.

    A discovery that raises is judged as one that says nothing; its time is the discovery's, reading included.
    """
    from benchmark.files.sessions.session_loading import load_session

    with tempfile.TemporaryDirectory(prefix="blind-") as parent:
        folder, made = case(name, Path(parent))
        started = time.perf_counter()
        try:
            answer = discover(load_session(folder), seed=name.seed)
        except Exception as error:
            return failed(made, error, time.perf_counter() - started)
        return judge(made, answer, time.perf_counter() - started)


def run_cases(
    cases: Sequence[CaseName], discoverer: str, journal: Path, workers: int, on_case: OnCase
) -> tuple[Judged, ...]:
    """Run the cases that the journal does not have yet.

    Parameters
    ----------
    cases : sequence of CaseName
    discoverer : str
        `module:function`.
    journal : Path
        Where each finished case is kept at once, a line of JSON.
    workers : int
        Processes; 1 is this one.
    on_case : callable
        Told how many of how many are finished, and the last one.

    Returns
    -------
    tuple of Judged
        In the order of `cases`.
    """
    finished = {row.case: row for row in read_rows(journal, Judged)}
    waiting = [name for name in cases if name.text not in finished]
    on_case(len(cases) - len(waiting), len(cases), None)
    with closing(Journal(journal)) as kept:
        for row in _work(waiting, discoverer, workers):
            kept.add(row)
            finished[row.case] = row
            on_case(sum(name.text in finished for name in cases), len(cases), row)
    return tuple(finished[name.text] for name in cases)


def _work(waiting: Sequence[CaseName], discoverer: str, workers: int) -> Iterator[Judged]:
    """Yield finished cases as they come; one worker is this process."""
    if workers == 1 or not waiting:
        yield from (_in_process(name, discoverer) for name in waiting)
        return
    context = multiprocessing.get_context("spawn")
    size = min(workers, len(waiting))
    with single_threaded_children(), ProcessPoolExecutor(size, context, initializer=end_with_parent) as pool:
        futures = [pool.submit(_in_process, name, discoverer) for name in waiting]
        try:
            for future in as_completed(futures):
                yield future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _in_process(name: CaseName, discoverer: str) -> Judged:
    return run_case(name, load_discoverer(discoverer))
