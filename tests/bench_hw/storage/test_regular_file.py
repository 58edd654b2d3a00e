"""Only regular files of bounded size are read; nothing waits for a pipe or reads a device without end."""

import os

import pytest

from bench_hw.storage.regular_file import NotRegularError, open_regular, read_regular, read_sealed, sealed


def test_a_regular_file_is_read_whole(tmp_path):
    (tmp_path / "a").write_bytes(b"12345")
    assert read_regular(tmp_path / "a", 5) == b"12345"
    with open_regular(tmp_path / "a", 5) as stream:
        assert stream.read(2) == b"12"


@pytest.mark.parametrize("kind", ["a pipe", "a device", "a folder"])
def test_what_is_no_file_is_named_at_once(tmp_path, kind):
    path = {"a pipe": tmp_path / "pipe", "a device": "/dev/zero", "a folder": tmp_path}[kind]
    if kind == "a pipe":
        os.mkfifo(path)  # nobody writes: opening it in the usual way would wait for ever
    with pytest.raises(NotRegularError, match=f"it is {kind}; allowed is a regular file"):
        read_regular(path)


def test_the_size_is_looked_at_before_reading(tmp_path):
    path = tmp_path / "large"
    with path.open("wb") as stream:
        stream.truncate(1 << 40)  # sparse: it takes no room, but reading it would
    with pytest.raises(NotRegularError, match=r"it has 1,099,512 MB; allowed are 16 MB"):
        read_regular(path)


def test_what_is_sealed_comes_back_whole_and_under_its_own_name_or_not_at_all(tmp_path):
    path, content = tmp_path / "kept", b"content of our own"
    path.write_bytes(sealed("kept", content))
    assert read_sealed(path, 100) == content
    whole = path.read_bytes()
    path.rename(tmp_path / "another")
    assert read_sealed(tmp_path / "another", 100) is None
    assert read_sealed(path, 100) is None
    for bit in range(8 * len(whole)):
        bad = bytearray(whole)
        bad[bit // 8] ^= 1 << bit % 8
        path.write_bytes(bad)
        assert read_sealed(path, 100) is None
    for size in range(len(whole)):
        path.write_bytes(whole[:size])
        assert read_sealed(path, 100) is None
    path.write_bytes(whole)
    assert read_sealed(path, len(whole) - 1) is None
    path.unlink()
    os.mkfifo(path)
    assert read_sealed(path, 100) is None


def test_a_file_whose_size_the_system_does_not_tell_is_bounded_too():
    with pytest.raises(NotRegularError, match="allowed are"):
        read_regular("/proc/self/maps", 10)
