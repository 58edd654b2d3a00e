"""What dead processes left behind: found in a folder and below, told from what is at work, and removed.

Only what carries our names and marks counts. A recording that was cut off is never litter: it is what a person comes
for, and `python -m bench_hw recover` saves it.
"""

from __future__ import annotations

import os
import re
import shutil
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from bench_hw.storage.folder_lock import in_use, is_free
from benchmark.discovery.evidence.pool import KEPT as KEPT_FIT
from benchmark.files.sessions.session_folder import RECORDING
from benchmark.runs.output.unfinished import is_kept
from reports.folders.building import dead_builds
from reports.manifest import ForeignFilesError, read_manifest, remove_known
from reports.result_folder import BACK, STAYS, WAITS, fate_of, recover

PART = re.compile(r"\.(?P<name>.+)\.[0-9a-f]{8}\.(?:part|tmp)")
"""A file that was being written."""
BESIDE = re.compile(r"\.(?P<name>.+)\.(?P<what>lock|previous|unfinished)")
"""What stands beside a result's place."""
GONE_BACK = "a result that stepped aside and goes back to its place"
OLD = 60.0
"""Seconds after which a file that was being written is no longer being written."""


@dataclass(frozen=True)
class Litter:
    """Something that a dead process left: where, what it is in words, its bytes, and whether all of it will go."""

    path: Path
    what: str
    size: int
    goes: bool = True


def find_litter(folder: Path) -> Iterator[Litter]:
    """What processes that are gone left in a folder and below; links are not followed."""
    for parent, folders, files in os.walk(folder):
        place = Path(parent)
        dead = set(dead_builds(place))
        for path in sorted(place / name for name in (*folders, *files)):
            what = "a result that was being written" if path in dead else _what(path)
            if what:
                yield Litter(path, what, _size(path), not path.name.endswith(".previous") or _fate(path) != STAYS)
        folders[:] = [name for name in folders if not (BESIDE.fullmatch(name) or PART.fullmatch(name))]


def unclosed_recordings(folder: Path) -> tuple[list[Path], list[Path]]:
    """Recordings in a folder and below that were cut off (no litter), and those where a capture is at work."""
    cut: list[Path] = []
    live: list[Path] = []
    for path in sorted(path for path in folder.rglob(f"*{RECORDING}") if path.is_file()):
        (live if in_use(path.parent) else cut).append(path)
    return cut, live


def remove(litter: Litter) -> bool:
    """Remove what was found, as far as it is ours; whether nothing of it is left."""
    path = litter.path
    if path.name.endswith(".previous"):
        with suppress(ForeignFilesError):
            recover(_place(path))
    elif path.name.endswith(".unfinished"):
        remove_known(path, _is_kept)
    elif path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)
    return not path.exists()


def fortune(litter: Litter, gone: bool | None) -> str:
    """What becomes of what was found, in words; before anything is removed (`gone` is None) what will."""
    if litter.what == GONE_BACK:
        return {None: "would go back", True: "is back"}.get(gone, "stays")
    if gone is None:
        return "would go" if litter.goes else "would stay in part, it holds other files"
    return "removed" if gone else "stays, it holds other files"


def _what(path: Path) -> str:
    """What a file or folder is that a dead process left, in words; empty for anything else.

    What stepped aside for a result that is not finished is no litter.
    """
    if path.is_symlink():
        return ""
    beside = BESIDE.fullmatch(path.name)
    if beside is None:
        stale = PART.fullmatch(path.name) and path.is_file() and time.time() - path.stat().st_mtime > OLD
        return "a file that was being written" if stale else ""
    if beside["what"] == "lock":
        return "a lock" if path.is_file() and is_free(path) else ""
    if not path.is_dir() or in_use(path.with_name(beside["name"])):
        return ""
    if beside["what"] == "previous":
        if read_manifest(path) is None or _fate(path) == WAITS:
            return ""
        return GONE_BACK if _fate(path) == BACK else "a result that was being replaced"
    ours = all(_is_kept(each.name) for each in path.rglob("*") if not each.is_dir())
    return "steps of a run that was stopped" if ours else ""


def _is_kept(name: str) -> bool:
    """Whether a file in a folder of unfinished work is ours, by its name: of the FEM, or a fit of a discovery."""
    return is_kept(name) or KEPT_FIT.fullmatch(name) is not None


def _place(previous: Path) -> Path:
    """The place of a result that stepped aside."""
    return previous.with_name(previous.name.removeprefix(".").removesuffix(".previous"))


def _fate(previous: Path) -> str:
    return fate_of(previous, _place(previous))


def _size(path: Path) -> int:
    files = [path] if path.is_file() else [each for each in path.rglob("*") if each.is_file()]
    return sum(file.lstat().st_size for file in files)
