import json
import os
import stat
from pathlib import Path

import numpy as np
import pytest

from reports.atomic import plain, write_bytes, write_json, write_text


def names(folder):
    return sorted(item.name for item in folder.iterdir())


def test_bytes_arrive_and_nothing_else_is_left(tmp_path):
    path = write_bytes(tmp_path / "new" / "a.bin", b"\x00\xff\r\n")
    assert path.read_bytes() == b"\x00\xff\r\n"
    assert names(path.parent) == ["a.bin"]


def test_text_keeps_its_line_ends(tmp_path):
    path = write_text(tmp_path / "a.txt", "µ\r\n\n")
    assert path.read_bytes() == "µ\r\n\n".encode()


def test_a_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    path = write_text(tmp_path / "a.txt", "old")

    def refuse(self, target):
        raise OSError("no rename today")

    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(OSError, match="no rename today"):
        write_text(path, "new")
    assert path.read_text() == "old"
    assert names(tmp_path) == ["a.txt"]


def test_a_failed_write_leaves_no_file(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "fsync", lambda handle: (_ for _ in ()).throw(OSError("disk full")))
    with pytest.raises(OSError, match="disk full"):
        write_text(tmp_path / "a.txt", "new")
    assert names(tmp_path) == []


def test_a_written_file_has_ordinary_permissions(tmp_path):
    ordinary = tmp_path / "ordinary"
    ordinary.touch()
    assert write_text(tmp_path / "a", "").stat().st_mode == ordinary.stat().st_mode


def test_json_knows_numpy_and_has_no_nan(tmp_path):
    value = {
        "a": np.array([1.0, np.nan]),
        "n": np.int64(3),
        "ok": np.bool_(True),
        "big": float("inf"),
        "path": Path("tables") / "x.csv",
        "t": (1, None),
        "µ": "µm",
    }
    text = write_json(tmp_path / "a.json", value).read_text(encoding="utf-8")
    assert json.loads(text) == {
        "a": [1.0, None], "n": 3, "ok": True, "big": None, "path": "tables/x.csv", "t": [1, None], "µ": "µm"
    }  # fmt: skip
    assert "µm" in text


def test_json_keeps_every_digit(tmp_path):
    numbers = np.random.default_rng(0).normal(size=50) * 10.0 ** np.arange(-25, 25)
    read = json.loads(write_json(tmp_path / "a.json", numbers).read_text())
    assert read == numbers.tolist()


@pytest.mark.parametrize(
    ("value", "message"),
    [({"a": {"b": [object()]}}, r"value\.a\.b\[0\] is a object"), ({1: 2}, "has the key 1, a int")],
)
def test_json_names_the_place_it_cannot_write(tmp_path, value, message):
    with pytest.raises(TypeError, match=message):
        write_json(tmp_path / "a.json", value)
    assert names(tmp_path) == []


def test_plain_turns_a_numpy_float_into_a_float():
    assert type(plain(np.float64(0.5))) is float


def test_a_folder_that_cannot_be_synchronised_has_the_file_all_the_same(tmp_path, monkeypatch):
    real = os.fsync

    def refuse_folders(handle):
        if stat.S_ISDIR(os.fstat(handle).st_mode):
            raise OSError(28, "No space left on device")
        real(handle)

    monkeypatch.setattr(os, "fsync", refuse_folders)
    assert write_bytes(tmp_path / "a", b"whole").read_bytes() == b"whole"
