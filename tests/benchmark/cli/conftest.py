"""The command line called in this process, its output caught."""

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from benchmark.cli.app import main
from benchmark.runs.output.pressed import Drawn


@dataclass(frozen=True)
class Called:
    """What a call left behind."""

    code: int
    out: str
    err: str


@pytest.fixture
def benchmark_cli(capfd: pytest.CaptureFixture[str]) -> Callable[..., Called]:
    def call(*arguments: object) -> Called:
        code = main([str(argument) for argument in arguments])
        out, err = capfd.readouterr()
        return Called(code, out, err)

    return call


@pytest.fixture(autouse=True)
def no_drawing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The pressed tissue's picture takes seconds and has tests of its own."""
    monkeypatch.setattr("benchmark.runs.output.pressed.draw_pressed", lambda *_: Drawn(b"", "left out of this test"))
