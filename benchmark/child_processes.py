"""Processes that this program starts, and what the user's code may not do to the process that it is loaded into.

First how a child begins and ends: one thread a library, without the user's script, deaf to Ctrl-C where its parent
answers for it, at an end when its parent is. Then what guards a process, child or not, against code and libraries in
it: they do not end it without a word (`forbid_ending`), nor write among its answers (`output_on_stderr`).
"""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager, suppress
from functools import cache
from multiprocessing import resource_tracker
from multiprocessing.context import SpawnContext, SpawnProcess
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, NoReturn, Protocol, TypeVar

THREAD_VARIABLES = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMEXPR_NUM_THREADS")


@contextmanager
def single_threaded_children() -> Iterator[None]:
    """Processes started inside have one thread per linear-algebra library; the parent keeps its own.

    They do not run the script that was started, as a spawned process otherwise does at its beginning: nothing that they
    need is in it, and a script that calls the harness outside of `if __name__ == "__main__"` would start itself anew.
    """
    before = {name: os.environ.get(name) for name in THREAD_VARIABLES}
    os.environ.update(dict.fromkeys(THREAD_VARIABLES, "1"))
    try:
        with _unnamed_script():
            yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def _unnamed_script() -> Iterator[None]:
    """Take from `__main__` what `multiprocessing` finds the script by, for a while."""
    main = sys.modules["__main__"]
    names: tuple[str, ...] = ("__spec__", "__file__")
    kept = {name: vars(main)[name] for name in names if name in vars(main)}
    vars(main).update(dict.fromkeys(kept))
    try:
        yield
    finally:
        vars(main).update(kept)


def start_child(process: BaseProcess) -> None:
    """Start a process with one thread a library, deaf to Ctrl-C from its first moment: that is the parent's business.

    A terminal sends it to all processes; one that is still importing would put a traceback between our words.
    """
    with single_threaded_children(), _deaf_at_first():
        process.start()


@contextmanager
def _deaf_at_first() -> Iterator[None]:
    """Processes started inside begin with Ctrl-C blocked."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # begun with the process, it would let the process hear again what is blocked
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # children begin with what is blocked here
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _PoolProcess(SpawnProcess):
    """A process of a pool, which starts it when work comes."""

    def start(self) -> None:
        """Start it deaf to Ctrl-C; `begin_in_pool` lets it hear again."""
        with _deaf_at_first():
            super().start()


class PoolContext(SpawnContext):
    """What a `ProcessPoolExecutor` takes its processes from; its `initializer` must call `begin_in_pool`."""

    Process = _PoolProcess


def begin_in_pool() -> None:
    """In a pool's process: end with the parent, and by Ctrl-C without a word, while importing as well as at work.

    Python would end each process with a traceback of its own, between the words of the parent.
    """
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


T = TypeVar("T")


class Mapped(Protocol):
    """What a function gives for each of some things, in their order, as `map` does."""

    def __call__(self, work: Callable[[Any], T], things: Iterable[Any], /) -> Iterable[T]:
        """The same."""
        ...


@contextmanager
def mapping(workers: int) -> Iterator[Mapped]:
    """`map` by so many processes; by this one where more would do nothing. Function and things can be pickled."""
    if workers <= 1:
        yield map
        return
    with single_threaded_children(), ProcessPoolExecutor(workers, PoolContext(), initializer=begin_in_pool) as executor:
        yield executor.map


def end_with_parent() -> None:
    """Make this process end when its parent is gone, killed or not; for the start of a pool's processes.

    A process of a spawned pool holds the writing end of its own queue, so it would wait for work for ever.
    """
    threading.Thread(target=_wait_for_parent, daemon=True).start()


def _wait_for_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


_really_exit = os._exit
_users_files: set[Path] = set()
"""Those that were loaded into this process."""


def forbid_ending(file: str) -> None:
    """From now on `os._exit` in the user's `file` raises SystemExit, so that the command line can say who ended it.

    Otherwise the process would end at once with the exit code that they chose, without a result and without a word.
    """
    _users_files.add(Path(file).absolute())
    os._exit = exit_unless_users


def exit_unless_users(status: int) -> NoReturn:
    """What stands for `os._exit`: SystemExit where a user's file calls it."""
    if Path(sys._getframe(1).f_code.co_filename).absolute() in _users_files:
        raise SystemExit(status)
    _really_exit(status)


@contextmanager
def output_on_stderr() -> Iterator[None]:
    """What is written to file descriptor 1 inside goes to stderr: by C libraries and by programs that are started.

    Python's own `sys.stdout` is not meant; `contextlib.redirect_stdout` leads that away. Of C's buffer, what is left
    inside is flushed before the way back. Without a stdout or a stderr nothing is led.
    """
    try:
        kept = os.dup(1)
    except OSError:
        yield
        return
    try:
        with suppress(OSError):
            os.dup2(2, 1)
        yield
    finally:
        _flush_c()
        os.dup2(kept, 1)
        os.close(kept)


def _flush_c() -> None:
    """Empty the buffers of C's own streams, where the system has one C library for the whole process."""
    with suppress(OSError, TypeError, AttributeError):
        _c_library().fflush(None)


@cache
def _c_library() -> ctypes.CDLL:
    return ctypes.CDLL(None)
