"""The hidden folder beside a result's place in which it is built: `.NAME.xxxxxxxx.part`.

It carries our mark from its first moment, and is locked for as long as its process lives, so that what a kill left is
told from what is at work, and from what is somebody else's.
"""

from __future__ import annotations

import json
import os
import re
import secrets
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from reports.manifest import MANIFEST, PROGRAM, SCHEMA, read_manifest, remove_empty

BUILDING = re.compile(r"\.(?P<name>.+)\.[0-9a-f]{8}\.part")


@contextmanager
def building(target: Path) -> Iterator[Path]:
    """Lend a new folder beside `target` to fill; it is removed at the end if it is still there.

    Missing folders above it are made, and removed again where they are empty then.
    """
    made = {folder for folder in target.parents if not folder.exists()}
    temporary = target.with_name(f".{target.name}.{secrets.token_hex(4)}.part")
    handle = None
    try:
        temporary.mkdir(parents=True)
        handle = _opened(temporary)
        if handle is not None:
            _hold(handle)
        mark = {"schema": SCHEMA, "program": PROGRAM, "files": {}}
        (temporary / MANIFEST).write_text(json.dumps(mark), encoding="utf-8")
        yield temporary
    finally:
        if handle is not None:
            os.close(handle)
        shutil.rmtree(temporary, ignore_errors=True)
        remove_empty(made)


def dead_builds(parent: Path, name: str | None = None) -> list[Path]:
    """Folders in `parent` in which a process that is gone built a result, `name` or any."""
    there = sorted(parent.iterdir()) if parent.is_dir() else []
    named = [(path, match["name"]) for path in there if (match := BUILDING.fullmatch(path.name))]
    return [path for path, built in named if name in (None, built) and _is_dead(path)]


def _is_dead(path: Path) -> bool:
    """Whether a folder carries our mark, or nothing yet, and nobody holds it."""
    if path.is_symlink() or not path.is_dir():
        return False
    return (read_manifest(path) is not None or not any(path.iterdir())) and not _is_held(path)


def remove_dead_builds(target: Path) -> None:
    """Remove what processes that are gone left of building `target`."""
    for path in dead_builds(target.parent, target.name):
        shutil.rmtree(path, ignore_errors=True)


def _opened(folder: Path) -> int | None:
    """A handle of a folder; None where the system gives none."""
    try:
        return os.open(folder, os.O_RDONLY)
    except OSError:
        return None


def _is_held(folder: Path) -> bool:
    """Whether a process that lives holds a folder; where the system knows no such locks, each is held."""
    handle = _opened(folder)
    if handle is None:
        return True
    try:
        return not _hold(handle)
    finally:
        os.close(handle)


def _hold(handle: int) -> bool:
    """Hold an open folder for this process; False where another one holds it, or the system knows no such locks."""
    if sys.platform == "win32":
        return False
    import fcntl

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
