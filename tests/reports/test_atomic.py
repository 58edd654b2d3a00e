import json
import os
from pathlib import Path

import numpy as np
import pytest

from reports.atomic import plain, whole_folder, write_bytes, write_json, write_text


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


def test_a_folder_appears_when_it_is_complete(tmp_path):
    target = tmp_path / "deep" / "result"
    with whole_folder(target) as folder:
        write_text(folder / "tables" / "a.csv", "1")
        assert not target.exists()
        assert folder.parent == target.parent
    assert (target / "tables" / "a.csv").read_text() == "1"
    assert names(target.parent) == ["result"]


def test_a_new_folder_replaces_the_whole_old_one(tmp_path):
    target = tmp_path / "result"
    (target / "old").mkdir(parents=True)
    with whole_folder(target) as folder:
        (folder / "new").touch()
        assert (target / "old").is_dir()
    assert names(target) == ["new"]
    assert names(tmp_path) == ["result"]


def fail(folder, error):
    (folder / "new").touch()
    raise error


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_an_exception_leaves_the_old_folder(tmp_path, error):
    target = tmp_path / "result"
    target.mkdir()
    (target / "old").touch()
    with pytest.raises(error), whole_folder(target) as folder:
        fail(folder, error)
    assert names(target) == ["old"]
    assert names(tmp_path) == ["result"]


def test_an_exception_leaves_no_new_parents(tmp_path):
    with pytest.raises(ValueError, match="bad input"), whole_folder(tmp_path / "a" / "b" / "c"):
        raise ValueError("bad input")
    assert names(tmp_path) == []


def test_an_old_folder_comes_back_if_the_new_one_cannot_take_its_place(tmp_path, monkeypatch):
    target = tmp_path / "result"
    target.mkdir()
    (target / "old").touch()
    rename = Path.rename

    def refuse_the_new_one(self, to):
        if (self / "new").exists():
            raise OSError("no rename today")
        return rename(self, to)

    monkeypatch.setattr(Path, "rename", refuse_the_new_one)
    with pytest.raises(OSError, match="no rename today"), whole_folder(target) as folder:
        (folder / "new").touch()
    assert names(target) == ["old"]
    assert names(tmp_path) == ["result"]


def test_a_file_is_no_place_for_a_folder(tmp_path):
    path = write_text(tmp_path / "result", "mine")
    with pytest.raises(FileExistsError, match="is a file"), whole_folder(path):
        pass
    assert path.read_text() == "mine"


def test_a_link_to_a_folder_stays_a_link(tmp_path):
    real = tmp_path / "real"
    real.mkdir()
    link = tmp_path / "latest"
    link.symlink_to(real)
    with whole_folder(link) as folder:
        (folder / "new").touch()
    assert link.is_symlink()
    assert names(real) == ["new"]
