"""How many threads the numerical libraries may use."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits

SMALL = 10_000


@contextmanager
def suited_threads(unknowns: int) -> Iterator[None]:
    """One thread for small systems, whose threads wait for each other longer than they work; otherwise no limit."""
    if unknowns >= SMALL:
        yield
        return
    with threadpool_limits(1):
        yield
