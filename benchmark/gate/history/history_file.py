"""The history of the checks: a file with one JSON object a line, only ever appended to."""

from __future__ import annotations

import errno
import json
import math
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmark.errors import InputError

HISTORY_SCHEMA = 1
HISTORY_SIGN = b'"machine": "'
"""What tells it from files that nothing must be added to, such as a baseline, whose machine is a table."""
IN_FOLDER = "history.jsonl"
"""Its name in a folder that is given for it."""


@dataclass(frozen=True)
class HistoryEntry:
    """One check.

    Attributes
    ----------
    made
        Date and time, UTC.
    revision
        Of the product; None outside a repository.
    machine
        Name of the processor.
    against
        The other revision that was measured beside; None for a stored baseline.
    passed
        The verdict; None where a baseline was accepted.
    accuracy
        Values by quantity, None where there was none.
    timing
        By quantity `ratio` (time in units of the references), `ci95` and `allowed`, the last two None where a baseline
        was accepted.
    """

    made: str
    revision: str | None
    machine: str
    against: str | None
    passed: bool | None
    accuracy: Mapping[str, float | None]
    timing: Mapping[str, Mapping[str, Any]]


def history_path(baseline: Path) -> Path:
    """The history that belongs to a baseline, beside it; raises InputError for a folder such as `.`."""
    if not baseline.name:
        raise InputError(f"--baseline {baseline} is a folder; give a file")
    return baseline.with_name(f"{baseline.stem}.history.jsonl")


def append(path: Path, entry: HistoryEntry) -> None:
    """Append a check, whole or not at all; raises OSError where the file system refuses."""
    path.parent.mkdir(parents=True, exist_ok=True)
    line = json.dumps({"schema": HISTORY_SCHEMA, **asdict(entry)}, ensure_ascii=False, allow_nan=False)
    whole = f"{'' if _ends_with_newline(path) else chr(10)}{line}\n".encode()
    handle = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o644)
    size = os.fstat(handle).st_size
    try:
        if os.write(handle, whole) < len(whole):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        os.fsync(handle)
    except OSError:
        os.ftruncate(handle, size)
        raise
    finally:
        os.close(handle)


def read_history(path: Path) -> tuple[list[HistoryEntry], int]:
    """Return the checks of a history, oldest first, and how many lines cannot be read; none where there is no file."""
    if not path.is_file():
        return [], 0
    lines = [line for line in path.read_bytes().splitlines() if line.strip()]
    entries = [entry for line in lines if (entry := _entry(line)) is not None]
    return entries, len(lines) - len(entries)


def _entry(line: bytes) -> HistoryEntry | None:
    """A line's check; None for one that was cut, or is of another schema."""
    try:
        table = json.loads(line)
        if table.pop("schema") != HISTORY_SCHEMA:
            return None
        entry = HistoryEntry(**table)
        usable = _is_whole(entry)
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError):
        return None
    return entry if usable else None


def _is_whole(entry: HistoryEntry) -> bool:
    """Whether everything in an entry is of its kind; raises for what is of no such kind at all."""
    words = (entry.made, entry.machine, *(each for each in (entry.revision, entry.against) if each is not None))
    numbers = [value for value in entry.accuracy.values() if value is not None]
    intervals = [each["ci95"] for each in entry.timing.values() if each.get("ci95") is not None]
    for each in entry.timing.values():
        numbers += [each["ratio"], *([] if each.get("allowed") is None else [each["allowed"]])]
    numbers += [end for interval in intervals for end in interval]
    return (
        all(isinstance(word, str) for word in words)
        and (entry.passed is None or isinstance(entry.passed, bool))
        and all(isinstance(number, int | float) and math.isfinite(number) for number in numbers)
        and all(each["ratio"] > 0.0 for each in entry.timing.values())
        and all(len(interval) == 2 for interval in intervals)
    )


def _ends_with_newline(path: Path) -> bool:
    """Whether a file is new, empty, or ends with a whole line."""
    if not path.is_file() or not path.stat().st_size:
        return True
    with path.open("rb") as stream:
        stream.seek(-1, os.SEEK_END)
        return stream.read(1) == b"\n"
