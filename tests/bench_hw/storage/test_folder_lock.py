"""One process at a time in a folder; a kill releases it."""

import os
import signal
import subprocess
import sys

import pytest

from bench_hw.storage.folder_lock import SIGN, FolderInUseError, is_free, lock_path, locked, scratch

HOLD = """
import sys, time
from pathlib import Path
from bench_hw.storage.folder_lock import locked
with locked(Path(sys.argv[1]), "hold"):
    print("held", flush=True)
    time.sleep(60)
"""


def test_the_second_is_refused_by_name_and_the_next_gets_in(tmp_path):
    folder = tmp_path / "deep" / "result"
    with locked(folder, "fit"):
        with pytest.raises(FolderInUseError, match=rf"result is in use \(fit, process {os.getpid()} on .* since "):
            locked(folder, "run").__enter__()
        assert not is_free(lock_path(folder))
    assert list(tmp_path.iterdir()) == [], "neither the lock nor the folders made for it stay"
    with locked(folder, "run"):
        pass


def test_a_link_to_a_folder_is_the_folder(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with locked(tmp_path / "a", "fit"), pytest.raises(FolderInUseError, match="in use"):
        locked(tmp_path / "b", "fit").__enter__()


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_a_kill_releases_it_and_the_next_removes_what_it_left(tmp_path):
    folder = tmp_path / "result"
    command = [sys.executable, "-c", HOLD, str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"held\n"
        with pytest.raises(FolderInUseError, match=f"hold, process {process.pid}"):
            locked(folder, "fit").__enter__()
        process.send_signal(signal.SIGKILL)
    assert lock_path(folder).read_text().startswith(SIGN)
    assert is_free(lock_path(folder))
    with locked(folder, "fit"):
        pass
    assert not lock_path(folder).exists()


def test_a_file_of_theirs_with_the_lock_s_name_is_left_as_it_is(tmp_path):
    lock_path(tmp_path / "result").write_text("my notes")
    with pytest.raises(FolderInUseError, match="but is another file"):
        locked(tmp_path / "result", "fit").__enter__()
    assert lock_path(tmp_path / "result").read_text() == "my notes"
    assert not is_free(lock_path(tmp_path / "result"))


SCRATCH = """
import os, signal
from bench_hw.storage.folder_lock import scratch
with scratch() as folder:
    (folder / "half").write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_killed_programs_temporary_files_go_with_the_next_and_those_of_a_living_one_stay(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    subprocess.run([sys.executable, "-c", SCRATCH], env={**os.environ, "TMPDIR": str(tmp_path)}, check=False)
    assert len(list(tmp_path.iterdir())) == 2
    with scratch() as first:
        (first / "mine").write_text("mine")
        with scratch() as second:
            assert (first / "mine").read_text() == "mine"
            assert sorted(tmp_path.iterdir()) == sorted([first, second, lock_path(first), lock_path(second)])
    assert not list(tmp_path.iterdir())


def test_a_file_where_a_folder_is_needed_is_named(tmp_path):
    (tmp_path / "file").write_text("mine")
    said = r"cannot be written: .*file is a file where a folder is needed$"
    with pytest.raises(OSError, match=said) as caught, locked(tmp_path / "file" / "p", "fit"):
        pass
    assert caught.value.strerror == f"{tmp_path / 'file'} is a file where a folder is needed"
