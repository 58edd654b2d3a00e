"""The page of a history: steps of times and values by commit, files whole, and what is no history refused."""

import json
from pathlib import Path

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.gate.history.history_file import HistoryEntry, append
from benchmark.gate.history.history_page import write_history


def check(number: int, ratio: float, value: float | None) -> HistoryEntry:
    timing = {"frame": {"ratio": ratio, "ci95": [0.99 * ratio, 1.01 * ratio], "allowed": 2.3}}
    return HistoryEntry(f"2026-01-{number:02d}T00:00", f"c{number:09d}", "A", None, ratio < 2.3, {"mm": value}, timing)


@pytest.fixture
def history(tmp_path: Path) -> Path:
    path, generator = tmp_path / "h.jsonl", np.random.default_rng(5)
    for number in range(1, 21):
        ratio = (2.0 if number < 12 else 2.4) * float(np.exp(0.01 * generator.normal()))
        append(path, check(number, ratio, 5.0 if number < 8 else 5.05))
    return path


def test_the_steps_are_named_by_commit(history: Path, tmp_path: Path) -> None:
    outcome = write_history(history, tmp_path / "page")
    steps = json.loads((outcome.folder / "history.json").read_text())["steps"]
    assert [(step["quantity"], step["commit"]) for step in steps] == [("frame", "c000000"), ("mm", "c000000")]
    assert [step["check"] for step in steps] == [12, 8]
    assert steps[0]["change_percent"] == pytest.approx(20.0, abs=2.0)
    assert steps[1]["change_percent"] == pytest.approx(1.0)
    assert outcome.headline == "2 steps in 20 checks, 9 of them red."
    assert "Values that moved" in outcome.folder.joinpath("report.html").read_text()


def test_a_file_without_checks_is_refused_and_nothing_is_written(tmp_path: Path) -> None:
    path = tmp_path / "h.jsonl"
    path.write_text("nonsense\n")
    with pytest.raises(InputError, match="holds no check"):
        write_history(path, tmp_path / "page")
    assert list(tmp_path.iterdir()) == [path]


def test_lines_that_cannot_be_read_are_said(history: Path, tmp_path: Path) -> None:
    with history.open("a") as stream:
        stream.write("{}\n")
    outcome = write_history(history, tmp_path / "page")
    assert outcome.document["unread_lines"] == 1
    assert "1 line of the file cannot be read" in outcome.folder.joinpath("report.html").read_text()
