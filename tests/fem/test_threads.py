"""How many threads suit a system, and work on parts in several of them."""

import os

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from fem.threads import NUMPY_LIBRARIES, SMALL, do_in_threads, in_parts, in_threads, suited_threads, usable_threads


def threads():
    """Threads of each library that has some."""
    return {(library["prefix"], library["filepath"]): library["num_threads"] for library in threadpool_info()}


def test_small_systems_get_one_thread_and_large_ones_one_in_numpy_alone():
    with threadpool_limits(2):
        before = threads()
        with suited_threads(SMALL - 1):
            assert set(threads().values()) == {1}
        with suited_threads(SMALL):
            expected = {key: 1 if key[0] in NUMPY_LIBRARIES else count for key, count in before.items()}
            assert threads() == expected
        assert threads() == before


def test_threads_are_the_processors_or_fewer_where_that_is_said(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2}, raising=False)
    for told, wanted in (("", 3), ("2", 2), ("8", 3), ("0", 3), ("2,1", 3)):
        monkeypatch.setenv("OMP_NUM_THREADS", told)
        assert usable_threads() == wanted


@pytest.mark.parametrize("count", [0, 1, 63, 64, 65, 2000])
@pytest.mark.parametrize("threads", ["1", "3"])
def test_each_part_is_worked_on_once(monkeypatch, threads, count):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2}, raising=False)
    monkeypatch.setenv("OMP_NUM_THREADS", threads)
    done = np.zeros(count, dtype=int)

    def work(part):
        done[part] += 1
        return part.start

    parts = in_parts(count, 64)
    assert list(in_threads(work, parts)) == [part.start for part in parts]
    assert (done == 1).all()


@pytest.mark.parametrize("threads", ["1", "3"])
def test_what_fails_in_a_thread_fails(monkeypatch, threads):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2}, raising=False)
    monkeypatch.setenv("OMP_NUM_THREADS", threads)

    def work(part):
        raise ValueError(part.start)

    with pytest.raises(ValueError, match="0"):
        do_in_threads(work, in_parts(200, 64))
