"""Where a result folder goes, and what it may replace: unchanged earlier results of ours and nothing else."""

from __future__ import annotations

import atexit
import os
import re
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from datetime import datetime
from pathlib import Path

from bench_hw.storage.folder_lock import FolderInUseError, is_free, locked
from benchmark.errors import InputError
from benchmark.files.sources import is_file
from reports import check_place

RESULTS = Path("results")
PROBE = 1 << 16
"""Bytes that are written before anything is computed."""
BEGINNING = 1 << 12
"""Bytes in which the sign of a file's kind must stand."""
NEEDED = 16_000_000
"""Bytes of a result without fields, its page with the embedded plots being the most of it (6 MB); an earlier result
stays until the new one is complete."""


@contextmanager
def claimed(out: Path | None, doing: str) -> Iterator[None]:
    """Keep other processes out of `out` while this one is `doing` something there; without `out` there is no need.

    Raises
    ------
    InputError
        Another process is at work in it, which the message names, or it cannot be written.
    """
    with ExitStack() as stack:
        if out is not None:
            try:
                stack.enter_context(locked(out, doing))
            except FolderInUseError as error:
                raise InputError(f"--out {error}") from None
            except (OSError, ValueError) as error:
                reason = getattr(error, "strerror", None) or error
                raise InputError(f"--out {out} cannot be written: {reason}") from error
        yield


def destination(out: Path | None, name: str, inputs: Iterable[Path | str | None] = (), needed: int = NEEDED) -> Path:
    """Return the folder for the result called `name`: `out`, or `results/NAME-DATE-TIME`.

    An unchanged earlier result at `out` will be replaced once the new one is complete. Anything else there is refused,
    since replacing it would lose it.

    Parameters
    ----------
    out
        What the user asked for.
    name
        Of the result; "" where only the place is checked so far.
    inputs
        What is read: paths, and texts that name a file or something that ships.
    needed
        Bytes that the result will take.

    Raises
    ------
    InputError
        `out` is a file, holds what is not ours, cannot be written, or is in or around an input; or there is too little
        room on its disk.
    """
    if out is None:
        _check_writable(RESULTS, "--out is not given, and results", needed)
        return fresh(name) if name else RESULTS
    check_ready(out, inputs, needed)
    try:
        check_place(out, f"--out {out}")
    except OSError as error:
        raise InputError(str(error)) from error
    return out


def check_ready(out: Path, inputs: Iterable[Path | str | None] = (), needed: int = NEEDED) -> None:
    """Refuse a folder that cannot be written, or is in or around an input; see `destination`."""
    for each in inputs:
        if each is not None and (isinstance(each, Path) or is_file(Path(each))):
            _check_apart(out, Path(each))
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out} is a file; it must be a folder that is new, empty, or an earlier result")
    _check_writable(out, f"--out {out}", needed)


def check_file(path: Path | None, option: str, sign: bytes, kind: str) -> None:
    """Refuse a file that cannot be written, a folder in its place, and one that is not what will be written there.

    Parameters
    ----------
    path
        The file, if one is asked for; it may be missing or empty.
    option
        How it was asked for.
    sign
        What stands in the first 4 kB of a file of its kind.
    kind
        Of the file, in words.

    Raises
    ------
    InputError
        The file is refused; nothing in it has changed.
    """
    if path is None:
        return
    if path.is_dir():
        raise InputError(f"{option} {path} is a folder; give a file")
    _check_writable(path, f"{option} {path}", PROBE)
    beginning = _beginning(path)
    if beginning and sign not in beginning:
        raise InputError(f"{option} {path} is there and is not {kind}; nothing else is replaced, give another name")


def remove_earlier(path: Path | None, sign: bytes) -> None:
    """Remove a file that carries the sign of its kind, so that it is not taken for what a command that failed wrote.

    Anything else stays, and so does a file that cannot be read or removed, which `check_file` tells of.
    """
    with suppress(OSError):
        if path is not None and sign in _beginning(path):
            path.unlink()


def _beginning(path: Path) -> bytes:
    """The bytes in which a sign must stand; none where there is no file."""
    if not path.is_file():
        return b""
    with path.open("rb") as stream:
        return stream.read(BEGINNING)


def fresh(name: str) -> Path:
    """Return `results/NAME-DATE-TIME`, which does not exist yet and is this process's until it ends.

    Two that begin in the same second would otherwise take the same name, and the later one replace the other's result.

    Raises
    ------
    InputError
        It cannot be claimed.
    """
    for left in RESULTS.glob(".*-????????-??????*.lock") if RESULTS.is_dir() else ():
        if is_free(left):  # of a process that was killed; nobody takes its name a second time
            left.unlink(missing_ok=True)
    moment = f"{file_name(name)}-{datetime.now():%Y%m%d-%H%M%S}"
    for path in (RESULTS / moment, *(RESULTS / f"{moment}-{number}" for number in range(2, 1000))):
        if not path.exists() and _is_claimed(path):
            return path
    raise InputError(f"{RESULTS / moment} and a thousand names like it are taken; give --out")


def _is_claimed(path: Path) -> bool:
    """Take a name until the end of this process; False where another process has it."""
    stack = ExitStack()
    try:
        stack.enter_context(locked(path.absolute(), "a result"))
    except FolderInUseError:
        return False
    except OSError as error:
        raise InputError(f"--out is not given, and {path} cannot be written: {error.strerror or error}") from error
    atexit.register(stack.close)
    return True


def file_name(name: str) -> str:
    """Return `name` with everything that file systems dislike replaced."""
    return re.sub(r"[^A-Za-z0-9._-]+", "-", name).strip("-.") or "run"


def _check_apart(out: Path, path: Path) -> None:
    """Refuse an input that is the output folder, in it, or around it, by whatever name or link."""
    if not path.exists():
        return
    place, read = out.resolve(), path.resolve()
    if any(_same(each, read) for each in (place, *place.parents)):
        raise InputError(f"--out {out} is {path} or in it, which is read; give a folder outside")
    if any(_same(each, place) for each in read.parents):
        raise InputError(f"--out {out} holds {path}, which is read; give another folder")


def _same(first: Path, second: Path) -> bool:
    return first == second or (first.exists() and second.exists() and first.samefile(second))


def _check_writable(out: Path, shown: str, needed: int) -> None:
    """Try now what would otherwise fail after everything is computed: a file beside the folder that will be made."""
    parent = next((each for each in out.absolute().parents if each.exists()), Path("/"))
    try:
        with suppress(FileNotFoundError):
            os.lstat(out.absolute().with_name(f".{out.name}.12345678.part"))  # a name that is too long
        with tempfile.TemporaryFile(dir=parent) as probe:
            probe.write(bytes(PROBE))
            probe.flush()
            os.fsync(probe.fileno())
            free = shutil.disk_usage(parent).free
    except OSError as error:
        raise InputError(f"{shown} cannot be written: {error.strerror or error}") from error
    if free < needed:
        raise InputError(
            f"{shown} has too little room: {free / 1e6:.0f} MB are free on its disk, and about {needed / 1e6:.0f} MB "
            "will be needed; make room, or give a folder on another disk"
        )
