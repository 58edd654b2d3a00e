"""Where the MKL is looked for, and how many threads suit a system."""

import os

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from fem.linear_solver import make_solver
from fem.linear_solver.factory import (
    NUMPY_LIBRARIES,
    SMALL,
    VARIABLE,
    do_in_threads,
    in_parts,
    in_threads,
    name_library,
    suited_threads,
    usable_threads,
)


@pytest.fixture
def environment(tmp_path):
    """A folder like an environment with the library."""
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "libmkl_rt.so.3").touch()
    return tmp_path


def test_the_library_of_the_environment_is_named(environment, monkeypatch):
    monkeypatch.setenv(VARIABLE, "to be restored")
    monkeypatch.delenv(VARIABLE)
    name_library(str(environment))
    assert os.environ[VARIABLE] == str(environment / "lib" / "libmkl_rt.so.3")


def test_the_user_s_choice_stays(environment, monkeypatch):
    monkeypatch.setenv(VARIABLE, "mine")
    name_library(str(environment))
    assert os.environ[VARIABLE] == "mine"


@pytest.mark.parametrize("count", [200, 20_000])
def test_other_limits_of_threads_do_not_reach_between_the_phases(count):
    """Analysed with two threads, factorised with one: Pardiso itself would crash."""
    indptr = np.append(np.arange(0, 2 * count - 1, 2), 2 * count - 1)
    indices = np.stack((np.arange(count), np.arange(1, count + 1)), axis=1).ravel()[:-1]
    data = np.where(np.arange(2 * count - 1) % 2 == 0, 4.0, 1.0)
    with threadpool_limits(2):
        solver = make_solver("auto", indptr, indices)
    with threadpool_limits(1):
        solver.factorise(data)
        x = solver.solve(np.ones((count, 1)))[:, 0]
    np.testing.assert_allclose(4 * x[1:-1] + x[:-2] + x[2:], 1.0, rtol=1e-12)


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
