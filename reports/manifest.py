"""The manifest of a result folder: which files in it are ours, so that nothing else is ever replaced or removed.

A file is ours where the manifest names it and its bytes are those that were written. Everything else in the folder is
foreign: other files, files changed since, empty folders, links. A folder without a manifest is foreign as a whole.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import stat
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

MANIFEST, PROGRAM, SCHEMA = "manifest.json", "tissuebench", 1
LEFTOVER = re.compile(r"\.(?P<name>.+)\.[0-9a-f]{8}\.part")
STEPS = re.compile(r"\w[\w.+-]*\.kept(?:\.[0-9]+\.part)?")
"""Files of ours in a folder that grows: steps of a computation that was stopped."""
PAGE = "report.html"
"""What every result that grows ends with; by it those of versions without `doing` are known to be complete."""
NAMED = 5
"""Foreign files that an error names."""


class ForeignFilesError(OSError):
    """A folder holds what we did not write, or what was changed since; it would be lost."""


@dataclass(frozen=True)
class Manifest:
    """What is ours in a folder.

    Attributes
    ----------
    files : mapping of str to set of str
        SHA-256 by path in the folder; two where a kill may have come between saying and writing.
    growing : frozenset of str
        Files and folders that change while a long computation is at work, known by name alone; in such a folder only
        steps of ours (`STEPS`) are.
    folders : frozenset of str
        Folders in it with a manifest of their own.
    doing : str
        What is at work there, or was stopped, as "sweep"; empty for a result that is complete.
    """

    files: Mapping[str, Collection[str]] = field(default_factory=dict)
    growing: frozenset[str] = frozenset()
    folders: frozenset[str] = frozenset()
    doing: str = ""


def read_manifest(folder: Path) -> Manifest | None:
    """The manifest of a folder; None where it has none of ours."""
    try:
        table = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        if table["program"] != PROGRAM or table["schema"] != SCHEMA:
            return None
        files: dict[str, set[str]] = {}
        for part in ("files", "pending"):
            for name, entry in table.get(part, {}).items():
                files.setdefault(name, set()).add(entry["sha256"])
        growing, folders = (frozenset(table.get(part, ())) for part in ("growing", "folders"))
        unnamed = "result" if growing and PAGE not in table["files"] else ""
        return Manifest(files, growing, folders, str(table.get("doing", unnamed)))
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None


def manifest_of(folder: Path) -> dict[str, Any]:
    """The manifest of all that is in a folder now; folders with one of their own are named and left to it."""
    nested = [name for name, path in _entries(folder) if _has_manifest(path)]
    files = {}
    for name, path in _entries(folder, skip=nested):
        if path.is_file() and name != MANIFEST:
            files[name] = {"size": path.stat().st_size, "sha256": sha256(path)}
    table: dict[str, Any] = {"schema": SCHEMA, "program": PROGRAM, "files": files}
    if nested:
        table["folders"] = nested
    return table


def foreign_files(folder: Path) -> list[str]:
    """Paths in a folder of what is not ours, or not as we wrote it; none for a folder that is not there."""
    manifest = read_manifest(folder) or Manifest()
    found = []
    parents = {str(parent) for name in manifest.files for parent in Path(name).parents}
    for name, path in _entries(folder, skip=manifest.folders):
        if name in manifest.folders and _has_manifest(path):
            found += [f"{name}/{each}" for each in foreign_files(path)]
        elif not _is_ours(name, path, manifest, parents):
            found.append(name)
    return found


def changed_files(folder: Path) -> list[str]:
    """Paths of the files in a folder of ours that are not as we wrote them; none for a folder that is not ours."""
    manifest = read_manifest(folder) or Manifest()
    return [name for name in foreign_files(folder) if name in manifest.files]


def said_of_changes(folder: Path) -> str:
    """Which files of a result of ours, its page apart, are not as they were written; empty where all are."""
    found = [name for name in changed_files(folder) if name != PAGE]
    return f"{folder}: not as they were written: {', '.join(found)}; what follows is of the changed files" * bool(found)


def refuse_foreign(folder: Path, shown: object = None, names: Collection[str] | None = None) -> None:
    """Raise ForeignFilesError where something in `folder`, in messages `shown`, is not ours.

    With `names` only these files count: they are to be replaced, and what lies beside them stays.
    """
    found = [name for name in foreign_files(folder) if names is None or name in names]
    if not found:
        return
    more = f" and {len(found) - NAMED} more" if len(found) > NAMED else ""
    listed = ", ".join(found[:NAMED]) + more
    name = folder if shown is None else shown
    if read_manifest(folder) is None:
        raise ForeignFilesError(
            f"{name} holds {listed} and no {MANIFEST}: it is not a result of this program, or one of an earlier "
            "version. Nothing in it is replaced; move it away, or give another folder (new or empty)"
        )
    raise ForeignFilesError(
        f"{name} holds files that this program did not write, or that were changed since: {listed}. Nothing is "
        "replaced; move them away, or give another folder"
    )


def refuse_unfinished(folder: Path, shown: object = None) -> None:
    """Raise ForeignFilesError where a computation that was stopped goes on from `folder`, in messages `shown`."""
    manifest = read_manifest(folder)
    if manifest is None or not manifest.doing:
        return
    kept = ", ".join(sorted(name for name in {*manifest.files, *manifest.growing} if (folder / name).exists()))
    raise ForeignFilesError(
        f"{folder if shown is None else shown} holds an unfinished {manifest.doing} ({kept}); the command that began "
        "it goes on with it. Nothing in it is replaced; give another folder, or move it away"
    )


def remove_ours(folder: Path) -> None:
    """Remove what is ours in a folder, the manifest last, and the folder where nothing else is in it."""
    manifest = read_manifest(folder)
    if manifest is None:
        return
    for name in manifest.folders:
        remove_ours(folder / name)
    for leftover in leftovers(folder):
        leftover.unlink()
    foreign = set(foreign_files(folder))
    for name in manifest.files:
        if name not in foreign:
            (folder / name).unlink(missing_ok=True)
    for name in manifest.growing - foreign:
        if (folder / name).is_dir():
            remove_known(folder / name, lambda each: STEPS.fullmatch(each) is not None)
        else:
            (folder / name).unlink(missing_ok=True)
    remove_empty({folder / parent for name in manifest.files for parent in Path(name).parents} - {folder})
    if [path for path in folder.iterdir() if path.name != MANIFEST]:
        return
    (folder / MANIFEST).unlink()
    folder.rmdir()


def remove_known(folder: Path, ours: Callable[[str], bool]) -> None:
    """Remove a folder's files whose names are `ours`, and each folder that is empty then; anything else stays."""
    if folder.is_symlink() or not folder.is_dir():
        return
    for parent, _, files in os.walk(folder, topdown=False):
        for name in files:
            path = Path(parent, name)
            if ours(name) and stat.S_ISREG(path.lstat().st_mode):
                path.unlink()
        remove_empty({Path(parent)})


def remove_empty(folders: Collection[Path]) -> None:
    """Remove those of the folders that are there and empty, innermost first."""
    for folder in sorted(folders, key=lambda each: -len(each.parts)):
        if folder.is_dir() and not folder.is_symlink() and not any(folder.iterdir()):
            folder.rmdir()


def sha256(path: Path) -> str:
    """Hash of a file's bytes."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def leftovers(folder: Path) -> list[Path]:
    """What a kill left of files of ours that were being written: `.NAME.xxxxxxxx.part`."""
    manifest = read_manifest(folder) or Manifest()
    return [path for name, path in _entries(folder, skip=manifest.folders) if _is_leftover(name, path, manifest)]


def _is_leftover(name: str, path: Path, manifest: Manifest) -> bool:
    found = LEFTOVER.fullmatch(path.name)
    if found is None or not stat.S_ISREG(path.lstat().st_mode):
        return False
    whole = str(Path(name).with_name(found["name"]))
    return whole == MANIFEST or whole in manifest.files


def _is_ours(name: str, path: Path, manifest: Manifest, parents: Collection[str]) -> bool:
    mode = path.lstat().st_mode
    if _is_leftover(name, path, manifest):
        return True
    if name in manifest.growing:
        return stat.S_ISREG(mode) or stat.S_ISDIR(mode)
    if any(name.startswith(f"{folder}/") for folder in manifest.growing):
        return stat.S_ISDIR(mode) or (stat.S_ISREG(mode) and STEPS.fullmatch(path.name) is not None)
    if stat.S_ISDIR(mode):
        return name in parents
    if name == MANIFEST:
        return manifest != Manifest()
    return stat.S_ISREG(mode) and name in manifest.files and sha256(path) in manifest.files[name]


def _has_manifest(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink() and read_manifest(path) is not None


def _entries(folder: Path, skip: Collection[str] = (), prefix: str = "") -> Iterator[tuple[str, Path]]:
    """Each thing in a folder and below, by its path in it, without what is in links and in folders to `skip`."""
    if not folder.is_dir():
        return
    for path in sorted(folder.iterdir()):
        name = f"{prefix}{path.name}"
        yield name, path
        if path.is_dir() and not path.is_symlink() and name not in skip:
            yield from _entries(path, skip, f"{name}/")
