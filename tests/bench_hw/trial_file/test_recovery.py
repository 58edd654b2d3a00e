"""Recovery: what is refused, and that a refusal leaves nothing behind. What is kept is in `test_damage`."""

import os
import subprocess
import sys

import pytest

from bench_hw.errors import TrialFileError
from bench_hw.trial_file.mcap_output import NewFile
from bench_hw.trial_file.recovery import recover_trial


@pytest.mark.parametrize("existing", ["new.mcap", "new.mcap.part"])
def test_an_existing_file_is_not_touched(three_seconds, tmp_path, existing):
    (tmp_path / existing).write_text("a measurement")
    with pytest.raises(TrialFileError, match="exists and is not overwritten"):
        recover_trial(three_seconds, tmp_path / "new.mcap")
    assert (tmp_path / existing).read_text() == "a measurement"


def test_a_file_is_not_recovered_onto_itself(three_seconds):
    before = three_seconds.read_bytes()
    with pytest.raises(TrialFileError, match="exists and is not overwritten"):
        recover_trial(three_seconds, three_seconds)
    assert three_seconds.read_bytes() == before


def test_another_ending_is_refused(three_seconds, tmp_path):
    with pytest.raises(TrialFileError, match=r"is named NAME\.mcap"):
        recover_trial(three_seconds, tmp_path / "new.csv")


def test_a_trial_without_records_has_nothing_to_keep(record, tmp_path):
    with pytest.raises(TrialFileError, match=r"nothing can be kept \(the trial has no records\)"):
        recover_trial(record([]), tmp_path / "new.mcap")
    assert not (tmp_path / "new.mcap").exists()


def test_a_disk_that_refuses_leaves_nothing_behind(three_seconds, tmp_path, monkeypatch):
    before = three_seconds.read_bytes()

    def refuse(self, data):
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(NewFile, "write", refuse)
    with pytest.raises(TrialFileError, match=r"cannot be written.*No space left"):
        recover_trial(three_seconds, tmp_path / "sub" / "new.mcap")
    assert list((tmp_path / "sub").iterdir()) == []
    assert three_seconds.read_bytes() == before


def test_the_result_says_it_in_json(three_seconds, tmp_path):
    result = recover_trial(three_seconds, tmp_path / "new.mcap").to_dict()
    assert result == {
        "schema": 1,
        "out": str(tmp_path / "new.mcap"),
        "whole": True,
        "reason": "",
        "kept": {"force": 3000, "depth": 301, "camera": 90, "events": 1},
        "lost_bytes": 0,
    }


def test_what_a_killed_recovery_left_is_removed_by_the_next(three_seconds, tmp_path):
    """A recording that was cut off stays `.part`; a recovery is a copy, and its litter has another name."""
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    left = tmp_path / f".new.mcap.{dead.pid:08x}.tmp"
    left.write_bytes(b"half")
    recover_trial(three_seconds, tmp_path / "new.mcap")
    assert sorted(path.name for path in tmp_path.iterdir() if "new" in path.name) == ["new.mcap"]
