"""Files of unfinished work: whole, of the same problem and solver, or refused."""

import os

import numpy as np
import pytest

import fem
from fem import kept_file
from fem.kept_file import fingerprint, read_kept, write_kept

ARRAYS = {"a": np.arange(12.0).reshape(3, 4), "b": np.array([1, 2, 3]), "c": np.float64(0.5)}


@pytest.fixture
def path(tmp_path):
    write_kept(tmp_path / "kept.npz", "form 1", "mine", ARRAYS)
    return tmp_path / "kept.npz"


def test_arrays_come_back(path):
    found = read_kept(path, "form 1", "mine")
    assert set(found) == set(ARRAYS)
    for name, array in ARRAYS.items():
        np.testing.assert_array_equal(found[name], array)
    assert [each.name for each in path.parent.iterdir()] == ["kept.npz"]
    assert read_kept(path.with_name("other.npz"), "form 1", "mine") is None


@pytest.mark.parametrize(("form", "owner"), [("form 2", "mine"), ("form 1", "yours")])
def test_what_belongs_to_something_else_is_refused(path, form, owner):
    with pytest.raises(fem.CheckpointError, match="is of another problem"):
        read_kept(path, form, owner)


def test_damage_is_refused_wherever_it_is(path):
    whole, draw = path.read_bytes(), np.random.default_rng(1)
    for n in range(300):
        bad = bytearray(whole[: draw.integers(len(whole))] if n % 3 == 0 else whole)
        for place in draw.integers(len(whole), size=4):
            if place < len(bad):
                bad[place] = draw.integers(256)
        path.write_bytes(bad)
        if bad != whole:
            with pytest.raises(fem.CheckpointError, match="is damaged or no checkpoint"):
                read_kept(path, "form 1", "mine")


def test_a_pipe_and_a_device_in_its_place_are_refused_unopened(path):
    path.unlink()
    path.symlink_to("/dev/zero")
    with pytest.raises(fem.CheckpointError, match="is no regular file"):
        read_kept(path, "form 1", "mine")
    path.unlink()
    os.mkfifo(path)
    with pytest.raises(fem.CheckpointError, match="is no regular file"):
        read_kept(path, "form 1", "mine")


def test_a_file_that_cannot_be_written_leaves_nothing(tmp_path):
    (tmp_path / "kept.npz").mkdir()
    with pytest.raises(fem.CheckpointError, match="cannot be written"):
        write_kept(tmp_path / "kept.npz", "form 1", "mine", ARRAYS)
    assert [each.name for each in tmp_path.iterdir()] == ["kept.npz"]


def test_the_fingerprint_knows_words_arrays_shapes_and_the_solver(monkeypatch):
    a = np.arange(6.0)
    found = {
        fingerprint("one", (a,)),
        fingerprint("two", (a,)),
        fingerprint("one", (a + 1e-15,)),
        fingerprint("one", (a.reshape(2, 3),)),
    }
    assert len(found) == 4
    assert fingerprint("one", (a.copy(),)) in found
    monkeypatch.setattr(kept_file, "_code", lambda: "another version")
    assert fingerprint("one", (a,)) not in found
