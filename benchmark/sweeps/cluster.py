"""Work on a Dask cluster, and what can go wrong with it that is nobody's scenario."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from functools import partial
from importlib import metadata
from typing import Any, TypeVar

from benchmark.errors import InputError
from benchmark.resumable import code_version
from benchmark.sweeps.point import PointResult, Task, evaluate, failed
from reports.formatting import counted


class ClusterError(InputError):
    """The Dask cluster is not there, cannot serve, or is gone; what is finished is on disk."""


Job = TypeVar("Job")
Row = TypeVar("Row")
PATIENCE = 10.0
"""Seconds for the scheduler to answer."""
CERTIFICATE = ", and its certificate in DASK_DISTRIBUTED__COMM__TLS__CA_FILE, ...__CLIENT__CERT and ...__CLIENT__KEY"
"""What `tls://` needs beside an address."""


ASKED: tuple[tuple[str, Callable[..., str], tuple[str, ...]], ...] = (
    ("the version of its tissuebench", metadata.version, ("tissuebench",)),
    ("the code of its tissuebench (SHA-256)", code_version, ()),
)
"""What a worker must answer as this program does."""


def work_on_cluster(tasks: Sequence[Task], address: str, say: Callable[[str], None]) -> Iterator[PointResult]:
    """Compute points on the cluster at `address` and yield each as it finishes; as `on_cluster`."""
    yield from on_cluster(evaluate, tasks, lambda task, reason: failed(task.point, reason), address, say)


def on_cluster(
    work: Callable[[Job], Row],
    jobs: Sequence[Job],
    lost: Callable[[Job, str], Row],
    address: str,
    say: Callable[[str], None],
) -> Iterator[Row]:
    """Work on the cluster at `address` and yield each row as it finishes.

    Parameters
    ----------
    work : callable
        Of a job: its row. Importable by the workers.
    jobs : sequence
    lost : callable
        The row of a job for which the cluster has no result, and why.
    address : str
        Of the Dask scheduler.
    say : callable
        Gets remarks on the cluster.

    Raises
    ------
    ClusterError
        Nobody answers there, a worker has another version or other code of this program, or none, or the scheduler is
        gone.
    """
    with _connected(address) as client:
        own = [function(*arguments) for _, function, arguments in ASKED]
        workers = _check_workers(client, address, own)
        say(f"{address}: {counted(workers, 'worker')}" if workers else f"{address}: no worker yet, waiting for one")
        try:
            yield from _rows(client, partial(_checked, own, address, work), jobs, lost)
        except (OSError, CancelledError):
            raise ClusterError(
                f"the Dask scheduler at {address} is gone; what is finished is kept, the same command goes on with it"
            ) from None


def _rows(
    client: Any, work: Callable[[Job], Row], jobs: Sequence[Job], lost: Callable[[Job, str], Row]
) -> Iterator[Row]:
    """The rows as they finish; an `OSError` or a cancelled future where the scheduler is gone."""
    import distributed

    as_completed: Any = distributed.as_completed
    futures = [client.submit(work, job, pure=False) for job in jobs]
    known = {future.key: job for future, job in zip(futures, jobs, strict=True)}
    for future in as_completed(futures):
        if future.status == "error":
            fault = future.exception()
            if isinstance(fault, ClusterError):  # of a worker that came later
                raise fault
            yield lost(known[future.key], _fault(fault))
        else:
            yield future.result()
        future.release()


@contextmanager
def _connected(address: str) -> Iterator[Any]:
    """A client of the cluster; what it logs of a lost connection is left out, since the error says it."""
    import distributed

    connect: Any = distributed.Client
    logs = [logging.getLogger(f"distributed.{name}") for name in ("client", "core", "batched", "comm.tcp")]
    levels = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.CRITICAL + 1)
    client = None
    try:
        try:
            client = connect(address, timeout=PATIENCE)
        except (OSError, ValueError, TypeError, RuntimeError) as error:
            raise ClusterError(
                f"--scheduler {address}: no Dask scheduler answers there within {PATIENCE:g} s "
                f"({type(error).__name__}); allowed: its address, such as tcp://127.0.0.1:8786"
                f"{CERTIFICATE if address.startswith('tls:') else ''}"
            ) from None
        yield client
    finally:
        if client is not None:
            client.close(timeout=PATIENCE)
        for log, level in zip(logs, levels, strict=True):
            log.setLevel(level)


def _check_workers(client: Any, address: str, own: Sequence[str]) -> int:
    """The number of workers; refuses those of another version or other code. Who comes later answers with each job."""
    answers: Mapping[str, Any] = {}
    for expected, (what, function, arguments) in zip(own, ASKED, strict=True):
        try:
            answers = client.run(function, *arguments, on_error="return")
        except OSError:
            raise ClusterError(f"the Dask scheduler at {address} is gone") from None
        for worker, answer in answers.items():
            if answer != expected:
                raise _other(address, worker, answer, what, expected)
    return len(answers)


def _checked(own: Sequence[str], address: str, work: Callable[[Job], Row], job: Job) -> Row:
    """The row of a job, by a worker that answers as `own` when it is asked for its version and code."""
    for expected, (what, function, arguments) in zip(own, ASKED, strict=True):
        answer = function(*arguments)
        if answer != expected:
            import distributed

            worker: Any = distributed.get_worker
            raise _other(address, worker().address, answer, what, expected)
    return work(job)


def _other(address: str, worker: str, answer: object, what: str, own: str) -> ClusterError:
    return ClusterError(
        f"--scheduler {address}: the worker {worker} answers {answer!r} when asked for {what}; allowed: {own}, as here"
    )


def _fault(error: BaseException | None) -> str:
    """Why the cluster has no result for a point."""
    if type(error).__name__ == "KilledWorker":
        return "its worker died again and again; the workers' logs say of what, often no memory left"
    return f"{type(error).__name__}: {error}"
