"""Trials and a way to run the command line, shared by the tests of the verbs."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from typer.testing import CliRunner

from bench_hw.cli import app
from bench_hw.trial_file import ForceRecord, FrameRecord, PositionRecord, TrialHeader, open_trial


@dataclass(frozen=True)
class Ran:
    exit_code: int
    stdout: str
    stderr: str


@pytest.fixture
def run() -> Callable[..., Ran]:
    """Run `python -m bench_hw ARGUMENTS` in this process."""

    def run_app(*arguments: object) -> Ran:
        result = CliRunner().invoke(app, [str(argument) for argument in arguments])
        return Ran(result.exit_code, result.stdout, result.stderr)

    return run_app


@pytest.fixture
def trial_file(tmp_path: Path) -> Path:
    """Two synthetic seconds: force at 1 kHz with records 200 to 202 and 500 lost, depth at 100 Hz, ten pictures."""
    header = TrialHeader("trial_001", "2024-05-06T07:08:09+00:00", 10.0, serials={"force": "FT1"}, synthetic=True)
    with open_trial(tmp_path / "trial_001.mcap", header, background=False) as writer:
        for n in range(2000):
            time = 10.0 + n / 1000
            press = math.sin(math.pi * n / 2000)
            if n + 1 not in (200, 201, 202, 500):
                writer.write_force(ForceRecord(time, n + 1, 7 * n, 0, (0.25, 0.5, -press), (0.0, 0.0, 0.125)))
            if n % 10 == 0:
                writer.write_position(PositionRecord(time, 2e-3 * press))
            if n % 200 == 0:
                writer.write_frame(FrameRecord(time, n // 200, bytes([n // 200]) * 50))
    return writer.path


@pytest.fixture
def cut_file(trial_file: Path, tmp_path: Path) -> Path:
    """The first half of the trial, as a kill leaves it."""
    path = tmp_path / "trial_002.mcap.part"
    content = trial_file.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    return path
