"""Where a result folder goes, and what it may replace: unchanged earlier results of ours and nothing else."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from datetime import datetime
from pathlib import Path

from benchmark.errors import InputError
from benchmark.files.sources import is_file
from reports import check_place

RESULTS = Path("results")
PROBE = 1 << 16
"""Bytes that must fit before anything is computed."""


def destination(out: Path | None, name: str, inputs: Iterable[Path | str | None] = ()) -> Path:
    """Return the folder for the result called `name`: `out`, or `results/NAME-DATE-TIME`.

    An unchanged earlier result at `out` will be replaced once the new one is complete. Anything else there is refused,
    since replacing it would lose it.

    Parameters
    ----------
    out
        What the user asked for.
    name
        Of the result.
    inputs
        What is read: paths, and texts that name a file or something that ships.

    Raises
    ------
    InputError
        `out` is a file, holds what is not ours, cannot be written, or is in or around an input.
    """
    if out is None:
        _check_writable(RESULTS, "--out is not given, and results")
        return fresh(name)
    check_ready(out, inputs)
    try:
        check_place(out, f"--out {out}")
    except OSError as error:
        raise InputError(str(error)) from error
    return out


def check_ready(out: Path, inputs: Iterable[Path | str | None] = ()) -> None:
    """Refuse a folder that cannot be written, or is in or around an input; see `destination`."""
    for each in inputs:
        if each is not None and (isinstance(each, Path) or is_file(Path(each))):
            _check_apart(out, Path(each))
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out} is a file; it must be a folder that is new, empty, or an earlier result")
    _check_writable(out, f"--out {out}")


def check_file(path: Path | None, option: str) -> None:
    """Refuse a file that cannot be written, or a folder in its place."""
    if path is None:
        return
    if path.is_dir():
        raise InputError(f"{option} {path} is a folder; give a file")
    _check_writable(path, f"{option} {path}")


def fresh(name: str) -> Path:
    """Return `results/NAME-DATE-TIME`, which does not exist yet."""
    return _fresh(RESULTS, f"{file_name(name)}-{datetime.now():%Y%m%d-%H%M%S}")


def _fresh(parent: Path, name: str) -> Path:
    """Return a path in `parent` that does not exist yet."""
    candidates = [parent / name, *(parent / f"{name}-{number}" for number in range(2, 1000))]
    return next(path for path in candidates if not path.exists())


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


def _check_writable(out: Path, shown: str) -> None:
    """Try now what would otherwise fail after everything is computed: a file beside the folder that will be made."""
    parent = next((each for each in out.absolute().parents if each.exists()), Path("/"))
    try:
        with suppress(FileNotFoundError):
            os.lstat(out.absolute().with_name(f".{out.name}.12345678.part"))  # a name that is too long
        with tempfile.TemporaryFile(dir=parent) as probe:
            probe.write(bytes(PROBE))
            probe.flush()
            os.fsync(probe.fileno())
    except OSError as error:
        raise InputError(f"{shown} cannot be written: {error.strerror or error}") from error
