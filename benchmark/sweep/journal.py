"""The journal of a sweep: one line of JSON for each finished point, on disk before the next one counts.

A line that a crash cut off is dropped when the journal is read again; its point is then computed anew.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from benchmark.sweep.point import PointResult


def read_journal(path: Path) -> dict[int, PointResult]:
    """The finished points by number; none without a journal."""
    if not path.exists():
        return {}
    whole, _, _ = path.read_bytes().rpartition(b"\n")
    return {row.point: row for row in _rows(whole)}


def _rows(text: bytes) -> Iterator[PointResult]:
    for line in text.splitlines():
        try:
            yield PointResult(**json.loads(line))
        except (ValueError, TypeError):
            continue


class Journal:
    """Appends finished points; `close` it, or use it as a context manager."""

    def __init__(self, path: Path):
        self._stream = path.open("ab")
        if self._stream.tell():
            self._stream.write(b"\n")  # ends a line that a crash cut off

    def add(self, row: PointResult) -> None:
        """Write one point through to the disk."""
        line = json.dumps(asdict(row), ensure_ascii=False, allow_nan=False)
        self._stream.write(line.encode() + b"\n")
        self._stream.flush()
        os.fsync(self._stream.fileno())

    def close(self) -> None:
        """Close the file."""
        self._stream.close()
