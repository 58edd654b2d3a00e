"""Result folders: written whole or not at all, and never over what we did not write (see `reports.manifest`).

A new result is built beside its place. An earlier one there steps aside as `.NAME.previous` and is removed, file by
file as its manifest says, once the new one is in place. A kill in between leaves both; `recover` puts that in order.
Beside a result that grows in its place the earlier one stays aside until `settle`.
"""

from __future__ import annotations

import hashlib
import json
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any, Final

from reports.atomic import StrPath, sync_folder, write_bytes, write_json
from reports.folders.building import building, remove_dead_builds
from reports.folders.reading_back import read_back
from reports.manifest import (
    MANIFEST,
    PROGRAM,
    SCHEMA,
    ForeignFilesError,
    foreign_files,
    leftovers,
    manifest_of,
    read_manifest,
    refuse_foreign,
    refuse_unfinished,
    remove_empty,
    remove_ours,
    sha256,
)

BACK: Final = "back"
GOES: Final = "goes"
STAYS: Final = "stays"
WAITS: Final = "waits"


class KeptElsewhereError(OSError):
    """A finished result could not be put in its place; it is kept beside it, or where there was room."""


@contextmanager
def whole_folder(path: StrPath, doing: str = "", growing: Collection[str] = ()) -> Iterator[Path]:
    """Build a result folder under a temporary name beside `path`, add its manifest, and put it in place.

    The context manager yields the folder to fill. An earlier result at `path` is replaced only when the new one is
    complete. On any exception inside, the temporary folder is removed and `path` stays untouched.

    Parameters
    ----------
    path
        The folder to make; missing parent folders are made (and removed again on an exception).
    doing, growing
        Of a result that is only begun here: what goes on in it, as "sweep", and the files and folders that will change
        without a word in the manifest. The earlier result then stays aside until `settle`.

    Raises
    ------
    FileExistsError
        If `path` is a file.
    ForeignFilesError
        If `path` holds what is not ours, or what is not finished.
    KeptElsewhereError
        If the result is complete but its place is not free any more; it is kept beside.
    OSError
        Where the file system refuses.
    """
    target = Path(path).resolve()
    check_place(target)
    with building(target) as temporary:
        yield temporary
        read_back(temporary)
        write_json(temporary / MANIFEST, {**manifest_of(temporary), **_at_work(doing, growing)})
        _put_in_place(temporary, target)
    sync_folder(target.parent)


def write_whole(path: StrPath, fill: Callable[[Path], None]) -> None:
    """Let `fill` write a result folder at `path`, as `whole_folder`; where that cannot be, keep it elsewhere.

    What took hours to compute is not lost to a disk that has filled up, a share that went away, or something that came
    into its place in the meantime.

    Raises
    ------
    KeptElsewhereError
        The result is complete, but in another place, which the message names.
    OSError
        It can be written nowhere.
    """
    try:
        with whole_folder(path) as new:
            fill(new)
    except KeptElsewhereError:
        raise
    except (ForeignFilesError, FileExistsError) as error:
        beside = _free(Path(path).resolve())
        with whole_folder(beside) as new:
            fill(new)
        raise KeptElsewhereError(f"{error}; the new result is kept in {beside}") from error
    except OSError as error:
        kept = _kept_elsewhere(Path(path).resolve(), fill)
        if kept is None:
            raise
        raise KeptElsewhereError(
            f"{path} cannot be written: {error.strerror or error}; the new result is kept in {kept}"
        ) from error


def _kept_elsewhere(target: Path, fill: Callable[[Path], None]) -> Path | None:
    """Write a result to the first place that takes it, and return it; None where there is none."""
    for place in (Path(tempfile.gettempdir()), Path.home()):
        kept = _free(place / "tissuebench-kept" / target.name)
        try:
            with whole_folder(kept) as new:
                fill(new)
        except OSError:
            continue
        return kept
    return None


def check_place(path: Path, shown: object = None) -> None:
    """Refuse a place that holds a file, or what is not ours or not finished; `shown` is its name in messages.

    What a kill left of an earlier replacement, and of building a result here, is put in order first.
    """
    target, name = path.resolve(), path if shown is None else shown
    recover(target)
    remove_dead_builds(target)
    if target.exists() and not target.is_dir():
        raise FileExistsError(f"{name} is a file; it must be a folder that is new, empty, or an earlier result")
    if target.is_mount():
        raise FileExistsError(f"{name} is where a disk is mounted; give a folder in it")
    refuse_foreign(target, name)
    refuse_unfinished(target, name)


def recover(target: Path) -> None:
    """Put in order what a kill left of a replacement: the earlier result comes back where the new one is not there yet.

    Raises
    ------
    ForeignFilesError
        `.NAME.previous` is something else, or has other files in it.
    """
    previous = place_aside(target)
    if not previous.is_dir():
        return
    if previous.is_symlink():
        raise ForeignFilesError(f"{previous} is a link where an earlier result steps aside; move it away")
    fate = fate_of(previous, target)
    if fate == BACK:
        if target.exists():
            target.rmdir()
        previous.rename(target)
    if fate in (BACK, WAITS):
        return
    remove_ours(previous)
    remove_empty({previous})
    if previous.exists():
        raise ForeignFilesError(
            f"{previous} is where an earlier result steps aside, but holds other files; move it away"
        )


def fate_of(previous: Path, target: Path) -> str:
    """What `recover` does with what stepped aside for `target`.

    BACK: it goes back, since nothing is in its place. WAITS: what is in its place is not finished, or not ours. GOES,
    STAYS: it is removed; with other files in it they stay, and so does the folder.
    """
    manifest, there = read_manifest(previous), read_manifest(target)
    if manifest is None:
        return STAYS if any(previous.iterdir()) else GOES
    free = not target.exists() or (target.is_dir() and not any(target.iterdir()))
    if free and any((previous / name).exists() for name in (*manifest.files, *manifest.folders)):
        return BACK
    if not free and (there is None or there.doing):
        return WAITS
    return STAYS if foreign_files(previous) else GOES


def settle(path: StrPath) -> None:
    """Say that a result that grew is complete, with the files that grew as they are now; the earlier one goes."""
    target = Path(path).resolve()
    table = _table(target)
    table.pop("doing", None)
    grown = {name: target / name for name in table.pop("growing", ()) if (target / name).is_file()}
    new = {name: {"size": each.stat().st_size, "sha256": sha256(each)} for name, each in grown.items()}
    write_json(target / MANIFEST, {**table, "files": dict(sorted({**table["files"], **new}.items()))})
    remove_ours(place_aside(target))


@contextmanager
def extended_folder(path: StrPath, doing: str = "", growing: Collection[str] = ()) -> Iterator[Path]:
    """Add files to a result folder that is ours or new, replacing those of the same names there.

    The context manager yields a folder to fill, whose files are then put into `path` one by one. What they will be is
    said in the manifest first, so that after a kill each file is known, old or new. What killed ones left beside `path`
    is removed.

    Parameters
    ----------
    path
        The result folder.
    doing, growing
        As of `whole_folder`, for a result that goes on; as before by default.

    Raises
    ------
    ForeignFilesError
        A file of one of these names is not ours, or was changed. Others beside them stay.
    """
    target = Path(path).resolve()
    remove_dead_builds(target)
    with building(target) as temporary:
        yield temporary
        read_back(temporary)
        refuse_foreign(target, path, manifest_of(temporary)["files"])
        _put_into(temporary, target, _at_work(doing, growing))


def replace_file(path: Path, data: bytes) -> None:
    """Replace a file that is ours in a result folder that is at work, without another look at the rest."""
    _say_and_write(path.parent, {path.name: data}, _table(path.parent))


def clear_leftovers(folder: Path) -> None:
    """Remove what a kill left of files being written in a result folder of ours."""
    for leftover in leftovers(folder):
        leftover.unlink()


def _at_work(doing: str, growing: Collection[str]) -> dict[str, Any]:
    """What the manifest of a result that grows says besides its files."""
    return ({"doing": doing} if doing else {}) | ({"growing": sorted(growing)} if growing else {})


def _put_into(temporary: Path, target: Path, at_work: Mapping[str, Any]) -> None:
    files = {name: (temporary / name).read_bytes() for name in manifest_of(temporary)["files"]}
    _say_and_write(target, files, {**_table(target), **at_work})


def _say_and_write(folder: Path, files: Mapping[str, bytes], table: dict[str, Any]) -> None:
    new = {name: {"size": len(data), "sha256": hashlib.sha256(data).hexdigest()} for name, data in files.items()}
    write_json(folder / MANIFEST, {**table, "pending": new})
    for name, data in files.items():
        write_bytes(folder / name, data)
    write_json(folder / MANIFEST, {**table, "files": dict(sorted({**table["files"], **new}.items()))})


def _table(folder: Path) -> dict[str, Any]:
    """The manifest of a folder of ours as a table; an empty one where there is none."""
    if read_manifest(folder) is None:
        return {"schema": SCHEMA, "program": PROGRAM, "files": {}}
    table: dict[str, Any] = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    pending = table.pop("pending", {})
    whole = {name: each for name, each in pending.items() if _is_whole(folder / name, each)}
    table["files"] = {**table["files"], **whole}
    return table


def _is_whole(path: Path, entry: Mapping[str, Any]) -> bool:
    return path.is_file() and sha256(path) == entry["sha256"]


def _put_in_place(temporary: Path, target: Path) -> None:
    """Rename `temporary` to `target`; an earlier result steps aside first and comes back if that fails."""
    previous = place_aside(target)
    try:
        check_place(target)
        _step_aside(target, previous)
        temporary.rename(target)
    except BaseException as error:
        if previous.exists() and not target.exists():
            previous.rename(target)
        kept = _free(target)
        if temporary.exists():
            temporary.rename(kept)
        if isinstance(error, OSError):
            raise KeptElsewhereError(f"{error}; the new result is kept in {kept}") from error
        raise
    if previous.exists() and fate_of(previous, target) != WAITS:
        remove_ours(previous)


def _step_aside(target: Path, previous: Path) -> None:
    """Take an earlier result out of the way, and back where something was added to it in the meantime."""
    if not target.exists():
        return
    if not any(target.iterdir()):
        target.rmdir()
        return
    target.rename(previous)
    refuse_foreign(previous, target)


def place_aside(target: Path) -> Path:
    """Where an earlier result steps aside; always the same, so that it is found after a kill."""
    return target.with_name(f".{target.name}.previous")


def _free(target: Path) -> Path:
    """A free name beside `target` for a result that cannot be put there."""
    return next(path for n in count(2) if not (path := target.with_name(f"{target.name}-{n}")).exists())
