"""The journal: what is whole in it is kept, wherever a crash cut it."""

import errno
import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmark.errors import InputError
from benchmark.resumable import Journal, begun, going_on, read_rows, say_waiting
from benchmark.sweeps.point import PointResult, failed

ROWS = [
    PointResult(1, "ok", None, "mind \u2026 the\ttab", {"x_mm": 1 / 3, "dermis.y": -1e-300}),
    failed(2, "no\nluck"),
    PointResult(3, "ok", None, None, {"x_mm": 5e-324}),
]


def read(path: Path) -> dict[int, PointResult]:
    return {row.point: row for row in read_rows(path, PointResult)}


def written(path: Path, rows=ROWS) -> Path:
    journal = Journal(path)
    for row in rows:
        journal.add(row)
    journal.close()
    return path


def test_where_an_earlier_result_waits_is_said(tmp_path: Path) -> None:
    said: list[str] = []
    for name in ("results.json", "plan.json"):
        with begun(tmp_path / "p", *(("sweep", ("journal.jsonl",)) if name == "plan.json" else ("", ()))) as new:
            (new / name).write_text("{}")
        say_waiting(tmp_path / "p", said.append)
    assert len(said) == 1
    assert f"the earlier result waits in {tmp_path / '.p.previous'} and goes once" in said[0]


def test_it_reads_back_exactly(tmp_path: Path) -> None:
    assert read(written(tmp_path / "j")) == {row.point: row for row in ROWS}
    assert read(tmp_path / "nowhere") == {}


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_a_cut_anywhere_keeps_the_whole_rows_and_can_go_on(tmp_path_factory, data) -> None:
    path = written(tmp_path_factory.mktemp("journal") / "j")
    whole = path.read_bytes()
    cut = data.draw(st.integers(0, len(whole)))
    path.write_bytes(whole[:cut])
    kept = whole[:cut].count(b"\n")
    assert read(path) == {row.point: row for row in ROWS[:kept]}
    missing = ROWS[kept:]
    journal = Journal(path)
    for row in missing:
        journal.add(row)
    journal.close()
    assert read(path) == {row.point: row for row in ROWS}


def test_lines_of_something_else_are_passed_over(tmp_path: Path) -> None:
    path = written(tmp_path / "j")
    path.write_bytes(b'\x00\x00\n{"point": 9}\n[1]\n' + path.read_bytes())
    assert read(path) == {row.point: row for row in ROWS}


def test_a_changed_row_is_none_and_said_and_one_without_a_checksum_is_read(tmp_path: Path) -> None:
    path = written(tmp_path / "j")
    said: list[str] = []
    path.write_text(path.read_text().replace("the\\ttab", "another"))
    assert [row.point for row in read_rows(path, PointResult, said.append)] == [2, 3]
    assert len(said) == 1
    assert f"{path} line 1 was changed" in said[0]
    rows = [json.loads(line) for line in path.read_text().splitlines()]
    assert all(row.pop("sha256") for row in rows)
    path.write_text("".join(json.dumps(row) + "\n" for row in rows))
    assert len(read(path)) == 3


def test_a_full_disk_says_what_stays_and_how_to_go_on(tmp_path: Path) -> None:
    match = r"sweep cannot be written: No space left.*the same command goes on"
    with pytest.raises(InputError, match=match), going_on(tmp_path / "sweep"):
        raise OSError(errno.ENOSPC, "No space left on device")
