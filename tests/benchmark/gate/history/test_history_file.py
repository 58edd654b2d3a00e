"""Histories on disk: only ever appended to, and lines of something else are passed over."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.gate.history.history_file import HistoryEntry, append, history_path, read_history

ENTRY = HistoryEntry(
    made="2026-01-02T03:04:05+00:00",
    revision="abc",
    machine="any",
    against=None,
    passed=True,
    accuracy={"skin_mm": 5.0, "gone_mm": None},
    timing={"frame": {"ratio": 2.0, "ci95": [1.9, 2.1], "allowed": 2.24}},
)


def test_entries_come_back_in_order(tmp_path: Path) -> None:
    path = tmp_path / "new" / "h.jsonl"
    assert read_history(path) == ([], 0)
    second = replace(ENTRY, passed=False)
    append(path, ENTRY)
    before = path.read_bytes()
    append(path, second)
    assert path.read_bytes().startswith(before)
    assert read_history(path) == ([ENTRY, second], 0)


def test_a_line_that_was_cut_is_left_and_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "h.jsonl"
    append(path, ENTRY)
    with path.open("ab") as stream:
        stream.write(b'{"schema": 1, "made": "2026')
    append(path, ENTRY)
    assert read_history(path) == ([ENTRY, ENTRY], 1)
    assert b'{"schema": 1, "made": "2026\n' in path.read_bytes()


@pytest.mark.parametrize(
    "line",
    [
        "[]",
        "nonsense",
        '{"schema": 2}',
        json.dumps({"schema": 1, "made": "x"}),
        json.dumps({"schema": 1, **vars(ENTRY), "timing": {"frame": {"ratio": 0.0}}}),
    ],
)
def test_lines_of_something_else_are_counted(tmp_path: Path, line: str) -> None:
    path = tmp_path / "h.jsonl"
    path.write_text(f"{line}\n")
    append(path, ENTRY)
    assert read_history(path) == ([ENTRY], 1)


@pytest.mark.parametrize(
    "odd",
    [
        {"passed": -0.05}, {"made": 3}, {"machine": None}, {"against": ["5 mm"]},
        {"accuracy": {"skin_mm": "/dev/zero"}}, {"revision": -0.0}, {"against": 0}, {"revision": False},
        {"timing": {"frame": {"ratio": 2.0, "ci95": 0.0}}}, {"timing": {"frame": {"ratio": 2.0, "ci95": []}}},
        {"timing": {"frame": {"ratio": 2.0, "allowed": ""}}},
        {"accuracy": {"skin_mm": float("inf")}}, {"accuracy": 7}, {"timing": {"frame": {"ratio": "2"}}},
        {"timing": {"frame": {"ratio": 2.0, "ci95": [1.0], "allowed": None}}},
        {"timing": {"frame": {"ratio": 2.0, "ci95": 7, "allowed": None}}}, {"accuracy": {"skin_mm": 10**400}},
    ],
)  # fmt: skip
def test_lines_whose_values_are_of_another_kind_are_counted(tmp_path: Path, odd: dict[str, object]) -> None:
    path = tmp_path / "h.jsonl"
    append(path, ENTRY)
    with path.open("a") as stream:
        stream.write(json.dumps({"schema": 1, **vars(ENTRY), **odd}) + "\n")
    assert read_history(path) == ([ENTRY], 1)


def test_it_stands_beside_the_baseline() -> None:
    assert history_path(Path("ci/b.json")) == Path("ci/b.history.jsonl")


def test_a_folder_has_no_history_beside_it() -> None:
    with pytest.raises(InputError, match=r"--baseline \. is a folder; give a file"):
        history_path(Path())
