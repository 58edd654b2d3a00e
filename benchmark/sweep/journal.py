"""The journal of a long computation: one line of JSON for each finished row, on disk before the next one counts.

A line that a crash cut off is dropped when the journal is read again; its row is then computed anew.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from benchmark.sweep.point import PointResult

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

RowType = TypeVar("RowType")


def read_journal(path: Path) -> dict[int, PointResult]:
    """The finished points by number; none without a journal."""
    return {row.point: row for row in read_rows(path, PointResult)}


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
        if self._stream.tell():
            self._stream.write(b"\n")  # ends a line that a crash cut off

    def add(self, row: DataclassInstance) -> None:
        """Write one row through to the disk."""
        line = json.dumps(asdict(row), ensure_ascii=False, allow_nan=False)
        self._stream.write(line.encode() + b"\n")
        self._stream.flush()
        os.fsync(self._stream.fileno())

    def close(self) -> None:
        """Close the file."""
        self._stream.close()
