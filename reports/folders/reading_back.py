"""Files are read back before a result is put in its place: what its readers would refuse must not get there."""

from __future__ import annotations

import csv
import io
import json
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

LARGEST: Final = 50_000_000
"""Bytes of a table beyond which only its first rows are read back."""
FIRST: Final = 1_000_000


class UnreadableResultError(RuntimeError):
    """A file that was written cannot be read; a fault of the program, never of its input."""


def read_back(folder: Path) -> None:
    """Read every JSON, TOML and CSV file of a folder.

    Raises
    ------
    UnreadableResultError
        Naming the file and what is wrong with it.
    """
    for path in sorted(folder.rglob("*")):
        reader = READERS.get(path.suffix)
        if reader is not None and path.is_file():
            try:
                reader(path)
            except (ValueError, RecursionError, csv.Error) as error:
                name = path.relative_to(folder).as_posix()
                raise UnreadableResultError(f"{name} was written but cannot be read back ({error})") from error


def _json(path: Path) -> None:
    json.loads(path.read_text(encoding="utf-8"), parse_constant=_no_json)


def _no_json(name: str) -> None:
    raise ValueError(f"{name} is no JSON")


def _toml(path: Path) -> None:
    tomllib.loads(path.read_text(encoding="utf-8"))


def _csv(path: Path) -> None:
    """Every row is as long as the header, whose names are there once each."""
    with path.open(encoding="utf-8", newline="") as stream:
        text = stream.read() if path.stat().st_size <= LARGEST else stream.read(FIRST).rpartition("\n")[0]
    rows = csv.reader(io.StringIO(text), strict=True)
    header = next(rows, [])
    if not header or len(set(header)) < len(header):
        raise ValueError(f"its header is {header}")
    for number, row in enumerate(rows, start=2):
        if len(row) != len(header):
            raise ValueError(f"row {number} has {len(row)} cells and the header {len(header)}")


READERS: Final[Mapping[str, Callable[[Path], None]]] = {".json": _json, ".toml": _toml, ".csv": _csv}
