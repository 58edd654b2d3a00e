"""One program at work in a folder: a lock beside it, `.NAME.lock`, that ends with the process, however that ends.

The lock is the system's on an open file, so that a kill releases it; the file says who holds it. One that a dead
process left is taken over by the next and removed at its end. So are folders for temporary files (`scratch`).
"""

from __future__ import annotations

import os
import secrets
import shutil
import socket
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path

SIGN = "tissuebench: "
"""Beginning of a lock's text; another file of that name is left alone."""
SCRATCH = "tissuebench-scratch-"
_LONGEST = 400


class FolderInUseError(OSError):
    """Another process is at work in a folder, or something else has the name of its lock."""


def lock_path(folder: Path) -> Path:
    """Where the lock of a folder is."""
    place = folder.resolve()
    return place.with_name(f".{place.name}.lock")


@contextmanager
def locked(folder: Path, doing: str) -> Iterator[None]:
    """Keep other processes out of a folder, which need not exist, until this one leaves the block or ends.

    Parameters
    ----------
    folder : pathlib.Path
        The folder; missing ones above it are made, and removed again if they stay empty.
    doing : str
        What is done in it, for the message that others get.

    Raises
    ------
    FolderInUseError
        Another process holds the lock, and the message says which; or the lock's name is taken by something else.
    OSError
        The lock cannot be written.
    """
    path = lock_path(folder)
    made = [each for each in path.parents if not each.exists()]
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        file = next((each for each in path.parents if each.exists() and not each.is_dir()), None)
        reason = error.strerror if file is None else f"{file} is a file where a folder is needed"
        problem = OSError(f"{folder} cannot be written: {reason}")
        problem.strerror = reason
        raise problem from error
    handle = _taken(path, folder)
    try:
        _say(handle, f"{doing}, process {os.getpid()} on {socket.gethostname()} since {datetime.now():%H:%M:%S}")
        yield
    finally:
        with suppress(OSError):
            path.unlink()  # while it is held, so that nobody else's is removed
        os.close(handle)
        for each in made:
            with suppress(OSError):
                each.rmdir()


@contextmanager
def scratch() -> Iterator[Path]:
    """An empty folder for temporary files, where the system has those; what killed programs left there goes first.

    Raises
    ------
    OSError
        It cannot be made.
    """
    parent = Path(tempfile.gettempdir())
    for lock in parent.glob(f".{SCRATCH}*.lock"):
        if is_free(lock):
            shutil.rmtree(parent / lock.stem.removeprefix("."), ignore_errors=True)
            with suppress(OSError):
                lock.unlink()
    folder = parent / f"{SCRATCH}{secrets.token_hex(8)}"
    with locked(folder, "temporary files"):
        try:
            folder.mkdir(mode=0o700)
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)


def is_free(path: Path) -> bool:
    """Whether a lock's file is left of a dead process: it carries our sign, or nothing, and nobody holds it."""
    try:
        handle = os.open(path, os.O_RDWR | getattr(os, "O_NOFOLLOW", 0))
    except OSError:
        return False
    try:
        text = os.read(handle, _LONGEST).decode("utf-8", "replace")
        return (not text or text.startswith(SIGN)) and _lock(handle)
    finally:
        os.close(handle)


def in_use(folder: Path) -> bool:
    """Whether a process, this one too, is at work in a folder."""
    lock = lock_path(folder)
    return lock.is_file() and not is_free(lock)


def _taken(path: Path, folder: Path) -> int:
    """A handle that holds the lock, and is the file that now has its name."""
    while True:
        handle = os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0), 0o644)
        try:
            text = os.read(handle, _LONGEST).decode("utf-8", "replace").strip()
            if text and not text.startswith(SIGN):
                problem = f"{path} is where {folder} is locked, but is another file; move it"
                raise FolderInUseError(problem)
            if not _lock(handle):
                who = text.removeprefix(SIGN) or "another process"
                raise FolderInUseError(f"{folder} is in use ({who}); wait for its end, or give another folder")
            if _is_there(handle, path):
                return handle
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)  # it was removed by the one who held it before; once more with the new one


def _is_there(handle: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(handle), path.lstat())
    except FileNotFoundError:
        return False


def _say(handle: int, text: str) -> None:
    """Write who holds a lock; a full disk is no reason not to hold it."""
    with suppress(OSError):
        os.lseek(handle, 0, os.SEEK_SET)
        os.ftruncate(handle, 0)
        os.write(handle, f"{SIGN}{text}\n".encode("utf-8", "replace"))


if sys.platform == "win32":

    def _lock(handle: int) -> bool:
        """Lock an open file for this process; False where another one holds it."""
        import msvcrt

        try:
            os.lseek(handle, _LONGEST, os.SEEK_SET)  # beyond the text, which others read
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        return True
else:

    def _lock(handle: int) -> bool:
        """Lock an open file for this process; False where another one holds it. Without such locks it goes on."""
        import fcntl

        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        except OSError:
            return True
        return True
