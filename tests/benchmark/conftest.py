"""Models side by side without starting processes, for tests that are not about the processes."""

import html
import multiprocessing
import pickle
import re
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from urllib.parse import unquote

import pytest

from benchmark.side_by_side import ModelProcess, runner, worker

TURN = threading.Lock()


class ModelThread(ModelProcess):
    """A model in a thread of this process: the same messages, pickled, by turns, and nothing is imported anew."""

    def __init__(self, model, scenario, *, every_field=False, core=None, own=None, keep=None):
        self.model = model
        self.connection, far_end = multiprocessing.Pipe()
        job = pickle.loads(pickle.dumps(worker.ModelJob(model, scenario, every_field, own, keep)))
        self._thread = threading.Thread(target=serve, args=(far_end, job), daemon=True)
        self._thread.start()

    def __exit__(self, kind, error, trace):
        if kind is None:
            self.connection.send(None)
            self._thread.join()
        self.connection.close()


def serve(connection, job):
    """Answer until the other end is closed, which after an error may be in the middle of a run."""
    with suppress(ConnectionResetError):
        worker.serve(connection, job, None)


@contextmanager
def models_in_threads() -> Iterator[None]:
    """`run_side_by_side` starts no processes; those have tests of their own in `side_by_side` and `cli`."""
    execute = worker._execute

    def by_turns(connection, command, job):
        with TURN:
            return execute(connection, command, job)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(worker, "_execute", by_turns)
        patch.setattr(runner, "ModelProcess", ModelThread)
        yield


@pytest.fixture(scope="session")
def threads() -> Callable[[], AbstractContextManager[None]]:
    """For a `with`, inside of which models run in threads."""
    return models_in_threads


@pytest.fixture(scope="module")
def in_threads(threads: Callable[[], AbstractContextManager[None]]) -> Iterator[None]:
    """Models run in threads in the whole module."""
    with threads():
        yield


def links_lead_somewhere(page: Path) -> None:
    """Every link of a page, where there is one, leads to a file beside it, to a part of it or into it."""
    text = page.read_text("utf-8") if page.is_file() else ""
    parts = set(re.findall(r' id="([^"]+)"', text))
    for link in map(html.unescape, re.findall(r' href="([^"]+)"', text)):
        if link.startswith("#"):
            assert link[1:] in parts, f"{page} has no {link}"
        elif not link.startswith("data:"):
            assert (page.parent / unquote(link)).exists(), f"{page} links to {link}, which is not there"


@pytest.fixture(scope="session")
def follow_links() -> Callable[[Path], None]:
    """The check of a page's links."""
    return links_lead_somewhere
