"""Result folders of long computations that go on where they were stopped: whose the files are, and the journal.

A journal has one line of JSON for each finished row, on disk before the next one counts, with the SHA-256 of the row.
A line that a crash cut off, or that was changed since, is dropped when the journal is read again; its row is then
computed anew. What goes on must be of the same code, or the rows would be of two: `code_version`.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from benchmark.errors import InputError
from benchmark.runs.output.destination import destination
from reports import whole_folder
from reports.manifest import ForeignFilesError, foreign_files, refuse_foreign
from reports.result_folder import place_aside

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

RowType = TypeVar("RowType")
MOST_NAMED = 5
CODE = ("benchmark", "fem", "wavemodel")
SEAL = "sha256"
"""Key of a row's hash in the journal; journals of earlier versions have none."""


@cache
def code_version() -> str:
    """Hash of the code that a result follows from, and the versions of what it computes with."""
    digest = hashlib.sha256(" ".join(version(name) for name in ("numpy", "scipy", "scikit-fem")).encode())
    root = Path(__file__).parents[1]
    for file in sorted(file for package in CODE for file in (root / package).rglob("*.py")):
        digest.update(file.relative_to(root).as_posix().encode() + file.read_bytes())
    return digest.hexdigest()


def check_files(path: Path, files: Collection[str], *, resumed: bool, no: str) -> None:
    """Refuse a folder in which the result's `files` are not as this program wrote them.

    Parameters
    ----------
    path, files
        The folder, and the files of the result in it.
    resumed
        Whether the folder holds such a result; what somebody else put beside it then stays.
    no
        What the files in another folder are, as "not a sweep".

    Raises
    ------
    InputError
        Naming the files.
    """
    if not resumed and (others := foreign_files(path)):
        raise InputError(
            f"--out {path} holds files that are {no} ({', '.join(others[:MOST_NAMED])}); "
            "it must be a folder that is new, empty, or an earlier result"
        )
    try:
        refuse_foreign(path, f"--out {path}", files)
    except OSError as error:
        raise InputError(str(error)) from error


@contextmanager
def begun(path: Path, doing: str, growing: Collection[str]) -> Iterator[Path]:
    """Lend a folder for the first files of a result that grows at `path`, put in place as a whole.

    A complete result of ours there steps aside until `reports.result_folder.settle` is told of the new one.

    Parameters
    ----------
    path
        The result folder.
    doing, growing
        What goes on in it, and what will change in it, as `whole_folder` takes them.

    Raises
    ------
    InputError
        The place holds something else, or an unfinished result.
    """
    destination(path, "")
    with whole_folder(path, doing, growing) as new:
        yield new


def say_waiting(path: Path, say: Callable[[str], None]) -> None:
    """Say where an earlier result is while the one that grows at `path` is not complete."""
    aside = place_aside(path.resolve())
    if aside.is_dir():
        say(f"the earlier result waits in {aside} and goes once this one is complete; it comes back if this one goes")


@contextmanager
def going_on(path: Path) -> Iterator[None]:
    """Say of a disk that is full, and the like, that what is finished at `path` stays and the same command goes on.

    Raises
    ------
    InputError
        The file system refused.
    """
    try:
        yield
    except ForeignFilesError:
        raise
    except OSError as error:
        raise InputError(
            f"--out {path} cannot be written: {error.strerror or error}; what is finished stays there, and the same "
            "command goes on from it"
        ) from error


def read_rows(
    path: Path, row_type: Callable[..., RowType], say: Callable[[str], None] = lambda _: None
) -> Iterator[RowType]:
    """The whole rows of a journal, made by `row_type` from their fields; none without a journal.

    `say` is told of each row that was changed since it was written, which is none.
    """
    if not path.exists():
        return
    whole, _, _ = path.read_bytes().rpartition(b"\n")
    for number, line in enumerate(whole.splitlines(), 1):
        try:
            table = json.loads(line)
            seal = table.pop(SEAL, None)
            row = row_type(**table)
        except (ValueError, TypeError, AttributeError, RecursionError):
            continue
        if seal is None or seal == _seal(table):
            yield row
        else:
            say(f"{path} line {number} was changed since it was written ({SEAL} differs): its row does not count")


def _text(table: dict[str, Any]) -> str:
    return json.dumps(table, ensure_ascii=False, allow_nan=False)


def _seal(table: dict[str, Any]) -> str:
    return hashlib.sha256(_text(table).encode()).hexdigest()


class Journal:
    """Appends finished rows, dataclasses of plain values; `close` it."""

    def __init__(self, path: Path):
        self._stream = path.open("ab")
        self._ending = b"\n" if self._stream.tell() else b""  # of a line that a crash cut off

    def add(self, row: DataclassInstance) -> None:
        """Write one row through to the disk."""
        table = asdict(row)
        line = _text({**table, SEAL: _seal(table)})
        self._stream.write(self._ending + line.encode() + b"\n")
        self._ending = b""
        self._stream.flush()
        os.fsync(self._stream.fileno())

    def close(self) -> None:
        """Close the file."""
        self._stream.close()
