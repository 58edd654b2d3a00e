"""Files are written whole or not at all."""

import os
import subprocess
import sys

import pytest

from bench_hw.errors import InputError
from bench_hw.storage.atomic import check_replaceable, replacing, write_text


def test_a_file_is_made_with_its_folder_and_the_usual_permissions(tmp_path):
    path = write_text(tmp_path / "new" / "a.txt", "µ\r\n")
    assert path.read_bytes() == "µ\r\n".encode()
    plain = tmp_path / "plain"
    plain.write_text("")
    assert path.stat().st_mode == plain.stat().st_mode


def test_what_was_there_stays_when_writing_fails(tmp_path):
    path = write_text(tmp_path / "a.txt", "before")
    with pytest.raises(UnicodeEncodeError), replacing(path) as temporary:
        temporary.write_text("after, half \ud800", encoding="utf-8")
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]


def test_only_a_file_of_the_same_kind_is_replaced(tmp_path):
    path = tmp_path / "trial.csv"
    check_replaceable(path, b"time_s,marker,", "a table of markers")
    path.write_text("time_s,marker,x_mm\n")
    check_replaceable(path, b"time_s,marker,", "a table of markers")
    path.write_text("time_s,depth_mm,force_N\n")
    with pytest.raises(InputError, match="is not a table of markers"):
        check_replaceable(path, b"time_s,marker,", "a table of markers")
    with pytest.raises(InputError, match="is a folder"):
        check_replaceable(tmp_path, b"", "anything")


def test_what_a_dead_process_left_of_writing_goes_with_the_next(tmp_path):
    with subprocess.Popen([sys.executable, "-c", ""]) as dead:
        pass
    theirs = [".a.toml.zzzzzzzz.tmp", ".b.toml.0000ffff.tmp", ".a.toml.00000001.tmp"]
    for name in (*theirs, f".a.toml.{dead.pid:08x}.tmp", f".a.toml.{os.getpid():08x}.tmp"):
        (tmp_path / name).write_text("half")
    write_text(tmp_path / "a.toml", "whole")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*theirs, "a.toml"])
