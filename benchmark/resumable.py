"""Result folders of long computations that go on where they were stopped: whose the files are, and the journal.

A journal has one line of JSON for each finished row, on disk before the next one counts. A line that a crash cut off is
dropped when the journal is read again; its row is then computed anew.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from benchmark.errors import InputError
from benchmark.runs.output.destination import destination
from reports import whole_folder
from reports.manifest import ForeignFilesError, foreign_files, refuse_foreign
from reports.result_folder import place_aside

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

RowType = TypeVar("RowType")
MOST_NAMED = 5


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


def read_rows(path: Path, row_type: Callable[..., RowType]) -> Iterator[RowType]:
    """The whole rows of a journal, made by `row_type` from their fields; none without a journal."""
    if not path.exists():
        return
    whole, _, _ = path.read_bytes().rpartition(b"\n")
    for line in whole.splitlines():
        try:
            yield row_type(**json.loads(line))
        except (ValueError, TypeError):
            continue


class Journal:
    """Appends finished rows, dataclasses of plain values; `close` it."""

    def __init__(self, path: Path):
        self._stream = path.open("ab")
        self._ending = b"\n" if self._stream.tell() else b""  # of a line that a crash cut off

    def add(self, row: DataclassInstance) -> None:
        """Write one row through to the disk."""
        line = json.dumps(asdict(row), ensure_ascii=False, allow_nan=False)
        self._stream.write(self._ending + line.encode() + b"\n")
        self._ending = b""
        self._stream.flush()
        os.fsync(self._stream.fileno())

    def close(self) -> None:
        """Close the file."""
        self._stream.close()
