"""The command line called in this process, its output caught."""

import pickle
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from benchmark.cli.app import main
from benchmark.runs.options import RunOptions
from benchmark.runs.output.pressed import Drawn
from benchmark.side_by_side import ModelProcess
from benchmark.sweeps.local import work_locally
from benchmark.sweeps.point import PointResult, Task, evaluate


@dataclass(frozen=True)
class Called:
    """What a call left behind."""

    code: int
    out: str
    err: str


@pytest.fixture
def benchmark_cli(capfd: pytest.CaptureFixture[str], follow_links: Callable[[Path], None]) -> Callable[..., Called]:
    def call(*arguments: object) -> Called:
        code = main([str(argument) for argument in arguments])
        out, err = capfd.readouterr()
        if code == 0 and "--out" in arguments:
            follow_links(Path(str(arguments[arguments.index("--out") + 1])) / "report.html")
        return Called(code, out, err)

    return call


@pytest.fixture(scope="module", autouse=True)
def no_drawing() -> Iterator[None]:
    """The pressed tissue's picture takes seconds and has tests of its own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("benchmark.runs.output.pressed.draw_pressed", lambda *_: Drawn(b"", "left out of this test"))
        yield


def timed_once(**options: object) -> RunOptions:
    """Options of a run whose repeats are one, however many were asked for."""
    return replace(RunOptions(**options), repeats=1)


def work_here(tasks: Sequence[Task], workers: int) -> Iterator[PointResult]:
    """Compute the points of a sweep one after the other in this process."""
    for task in tasks:
        yield pickle.loads(pickle.dumps(evaluate(pickle.loads(pickle.dumps(task)))))


@pytest.fixture(scope="module", autouse=True)
def quick_runs(in_threads: None) -> Iterator[None]:
    """Runs are timed once, as a repeat is the same again, and nothing starts processes, but where all is `as_told`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("benchmark.runs.RunOptions", timed_once)
        patch.setattr("benchmark.sweeps.sweep_run.work_locally", work_here)
        yield


@pytest.fixture
def as_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs are timed as often as the command says, each model and the points of a sweep in processes of their own."""
    monkeypatch.setattr("benchmark.runs.RunOptions", RunOptions)
    monkeypatch.setattr("benchmark.side_by_side.runner.ModelProcess", ModelProcess)
    monkeypatch.setattr("benchmark.sweeps.sweep_run.work_locally", work_locally)
