"""Writing files whole or not at all: a temporary name beside the target, then a rename.

The trial file being recorded is no such file (it must survive a kill in the middle): see `trial_file`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from bench_hw.errors import InputError

ReadBack = Callable[[Path], object]

_BEGINNING = 1 << 12
"""Bytes in which the sign of a file's kind must stand."""


@contextmanager
def replacing(path: Path, read_back: ReadBack | None = None) -> Iterator[Path]:
    """Give a temporary path in the target's folder and rename it to the target when the block succeeds.

    Parameters
    ----------
    path : pathlib.Path
        The file to make or replace. Its folder is made where it is missing.
    read_back : callable, optional
        Reads what was written, from its temporary path, before it is put in place; what it raises is raised.

    Yields
    ------
    pathlib.Path
        Where to write. It is removed, and the target left as it was, if the block raises.

    Raises
    ------
    OSError
        The folder cannot be made or written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    remove_dead(path, "tmp")
    temporary = path.with_name(f".{path.name}.{os.getpid():08x}.tmp")
    try:
        yield temporary
        _sync(temporary)
        if read_back is not None:
            read_back(temporary)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_bytes(path: Path, data: bytes, read_back: ReadBack | None = None) -> Path:
    """Write bytes whole or not at all, and return the path; `read_back` as in `replacing`.

    Raises
    ------
    OSError
        The folder cannot be made or written, or the disk is full.
    """
    with replacing(path, read_back) as temporary:
        temporary.write_bytes(data)
    return path


def write_text(path: Path, text: str, read_back: ReadBack | None = None) -> Path:
    """Write text as UTF-8 with the line ends as given, whole or not at all; return the path; see `write_bytes`.

    Raises
    ------
    OSError
        The folder cannot be made or written, or the disk is full.
    """
    return write_bytes(path, text.encode("utf-8"), read_back)


def check_replaceable(path: Path, sign: bytes, kind: str) -> None:
    """Refuse to replace a file that is not of the kind that will be written, told by `sign` in its beginning.

    Raises
    ------
    InputError
        The file is another, or is no file.
    """
    if path.is_dir():
        raise InputError(f"{path}: is a folder; allowed: the name of a file")
    if path.is_file():
        with path.open("rb") as stream:
            if sign not in stream.read(_BEGINNING):
                raise InputError(f"{path}: the file exists and is not {kind}; nothing else is replaced, give another")


def remove_dead(target: Path, ending: str) -> None:
    """Remove what processes that are gone left of writing `target`: `.NAME.NUMBER.ENDING`, their numbers in hex."""
    if os.name != "posix":
        return
    part = re.compile(re.escape(f".{target.name}.") + rf"([0-9a-f]{{8}})\.{ending}")
    for path in target.parent.iterdir():
        match = part.fullmatch(path.name)
        if match and path.is_file() and not path.is_symlink() and not _lives(int(match[1], 16)):
            path.unlink(missing_ok=True)


def _lives(process: int) -> bool:
    """Whether a process of this number is there, this one apart, which has nothing else to write."""
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return process != os.getpid()


def _sync(path: Path) -> None:
    handle = os.open(path, os.O_RDWR)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
