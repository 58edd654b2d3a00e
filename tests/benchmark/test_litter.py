"""What killed runs left is found and removed; everything else stays."""

import os
import re
import time
from pathlib import Path

import pytest

from bench_hw.storage.folder_lock import locked
from benchmark.cli.folders.results import clean
from benchmark.errors import InputError
from benchmark.files.sessions.session_folder import session_table
from benchmark.litter import find_litter, remove, unclosed_recordings
from reports import whole_folder


@pytest.fixture
def place(tmp_path):
    """A folder after a bad day: a good result, what four dead processes left, and files of somebody else."""
    with whole_folder(tmp_path / "good") as new:
        (new / "results.json").write_text("{}")
    long_ago = time.time() - 3600
    dead = tmp_path / ".fit.0123abcd.part"
    dead.mkdir()
    (dead / "manifest.json").write_text('{"schema": 1, "program": "tissuebench", "files": {}}')
    (dead / "half.csv").write_text("a,")
    (tmp_path / ".baseline.json.89abcdef.part").write_text("{")
    (tmp_path / ".camera.toml.89abcdef.tmp").write_text("[")
    for name in (".baseline.json.89abcdef.part", ".camera.toml.89abcdef.tmp"):
        os.utime(tmp_path / name, (long_ago, long_ago))
    (tmp_path / ".press.lock").write_text("tissuebench: run, process 1 on here since 10:00:00\n")
    (tmp_path / ".press.unfinished").mkdir()
    (tmp_path / ".press.unfinished" / "fem_mesh.kept").write_bytes(b"1")
    (tmp_path / "session").mkdir()
    (tmp_path / "session" / "trial_001.mcap.part").write_bytes(b"2")
    (tmp_path / ".theirs.unfinished").mkdir()
    (tmp_path / ".theirs.unfinished" / "thesis.docx").write_bytes(b"3")
    (tmp_path / ".theirs.lock").write_text("mine")
    (tmp_path / "notes.part").write_text("mine")
    return tmp_path


def test_each_kind_is_found_and_removed_and_nothing_else(place):
    found = list(find_litter(place))
    assert {each.path.name for each in found} == {
        ".fit.0123abcd.part", ".baseline.json.89abcdef.part", ".camera.toml.89abcdef.tmp",
        ".press.lock", ".press.unfinished",
    }  # fmt: skip
    assert all(remove(each) for each in found)
    assert list(find_litter(place)) == []
    assert sorted(path.name for path in place.iterdir()) == [
        ".theirs.lock", ".theirs.unfinished", "good", "notes.part", "session",
    ]  # fmt: skip
    cut, live = unclosed_recordings(place)
    assert ([path.name for path in cut], live) == (["trial_001.mcap.part"], [])


def test_what_is_at_work_is_left_alone(place):
    with locked(place / "press", "run"):
        assert {".press.lock", ".press.unfinished"}.isdisjoint(each.path.name for each in find_litter(place))


def test_a_recording_whose_capture_is_at_work_was_not_cut_off(place, capsys):
    session = place / "session"
    with locked(session, "capture"):
        assert unclosed_recordings(place) == ([], [session / "trial_001.mcap.part"])
        with pytest.raises(InputError, match=r"trial_001\.mcap\.part is still being recorded$"):
            session_table(session)
        clean(place)
        said = capsys.readouterr().out
    assert f"{session / 'trial_001.mcap.part'}: is being recorded, left alone" in said
    assert "cut off" not in said
    assert unclosed_recordings(place) == ([session / "trial_001.mcap.part"], [])


def test_recordings_are_looked_for_once(place, monkeypatch):
    walked, whole = [], Path.rglob
    monkeypatch.setattr(Path, "rglob", lambda self, pattern: walked.append(pattern) or whole(self, pattern))
    clean(place, dry_run=True)
    assert walked.count("*.mcap.part") == 1


def test_a_file_that_is_just_being_written_is_left_alone(tmp_path):
    (tmp_path / ".a.json.0123abcd.part").write_text("{")
    assert list(find_litter(tmp_path)) == []


def test_an_earlier_result_that_stepped_aside_comes_back(tmp_path):
    with whole_folder(tmp_path / "result") as new:
        (new / "a").write_text("1")
    (tmp_path / "result").rename(tmp_path / ".result.previous")
    (found,) = find_litter(tmp_path)
    assert remove(found)
    assert (tmp_path / "result" / "a").read_text() == "1"


def test_what_steps_aside_is_told_truly_before_it_goes_and_after(tmp_path, capsys):
    """What a sweep had left of itself `would go`, and then stayed, in the way of the next command."""
    for name in ("grown", "mixed"):
        with whole_folder(tmp_path / name) as new:
            (new / "b").write_text("2")
    for name in ("grown", "mixed", "waits", "back"):
        with whole_folder(tmp_path / f".{name}.previous", "sweep", ("journal.jsonl", "unfinished")) as new:
            (new / "a").write_text("1")
        (tmp_path / f".{name}.previous" / "journal.jsonl").write_text("{}")
    for name in ("grown", "mixed"):
        (tmp_path / f".{name}.previous" / "a").unlink()
    (tmp_path / ".waits.previous").rename(tmp_path / "aside")
    (tmp_path / ".mixed.previous" / "notes.txt").write_text("mine")
    with whole_folder(tmp_path / "waits", "sweep", ("journal.jsonl",)) as new:
        (new / "b").write_text("2")
    (tmp_path / "aside").rename(tmp_path / ".waits.previous")
    clean(tmp_path, dry_run=True)
    said = capsys.readouterr().out.splitlines()
    assert [line.partition("previous: ")[2].split(", ")[-1] for line in said] == [
        "would go back", "would go", "it holds other files",
    ]  # fmt: skip
    clean(tmp_path)
    said = capsys.readouterr().out.splitlines()
    assert [line.split(", ")[-1] for line in said] == ["is back", "removed", "it holds other files"]
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        ".mixed.previous", ".waits.previous", "back", "grown", "mixed", "waits",
    ]  # fmt: skip
    assert (tmp_path / ".mixed.previous" / "notes.txt").read_text() == "mine"
    assert (tmp_path / ".waits.previous" / "a").read_text() == "1"


def test_the_way_to_save_a_recording_can_be_typed_as_it_stands(tmp_path, capsys):
    (tmp_path / "my session").mkdir()
    recording = tmp_path / "my session" / "trial_001.mcap.part"
    recording.write_bytes(b"")
    way = f"python -m bench_hw recover '{recording}' --out NEW.mcap"
    clean(tmp_path)
    assert way in capsys.readouterr().out
    with pytest.raises(InputError, match=re.escape(way)):
        session_table(recording.parent)
