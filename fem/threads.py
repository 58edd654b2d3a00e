"""How many threads the work may have, and work on parts in several of them."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

from threadpoolctl import threadpool_limits

SMALL = 10_000
"""Unknowns below which one thread is faster than several."""
AHEAD = 4  # parts of a work for each thread
NUMPY_LIBRARIES = ("libopenblas", "libscipy_openblas", "openblas")
Result = TypeVar("Result")


@contextmanager
def suited_threads(unknowns: int) -> Iterator[None]:
    """One thread for small systems, whose threads wait for each other longer than they work.

    Large systems have several in the linear solver, one in NumPy: its products are of 64 elements at a time, and beside
    another program their threads took ten times as long as one.
    """
    with threadpool_limits(1 if unknowns < SMALL else dict.fromkeys(NUMPY_LIBRARIES, 1)):
        yield


def usable_threads() -> int:
    """As many as this process has processors, or fewer where OMP_NUM_THREADS says so."""
    told = os.environ.get("OMP_NUM_THREADS", "")
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(int(told), usable) if told.isdigit() and int(told) > 0 else usable


def in_threads(work: Callable[[slice], Result], parts: Sequence[slice]) -> Iterator[Result]:
    """Results of the work on all parts in their order, on as many threads as may be used, few ahead of their use."""
    count = min(usable_threads(), len(parts))
    if count <= 1:
        yield from map(work, parts)
        return
    with ThreadPoolExecutor(count) as pool:
        ahead: deque[Future[Result]] = deque()
        for part in parts:
            ahead.append(pool.submit(work, part))
            if len(ahead) > AHEAD * count:
                yield ahead.popleft().result()
        while ahead:
            yield ahead.popleft().result()


def do_in_threads(work: Callable[[slice], None], parts: Sequence[slice]) -> None:
    """Do the work on all parts, on as many threads as may be used; what it writes must not overlap."""
    for _ in in_threads(work, parts):
        pass


def in_parts(count: int, size: int) -> list[slice]:
    """Slices of at most `size` that cover 0 to count."""
    return [slice(start, min(start + size, count)) for start in range(0, count, size)]
