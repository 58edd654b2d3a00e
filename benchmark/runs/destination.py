"""Where a result folder goes, and what it may replace."""

from __future__ import annotations

import re
from datetime import datetime
from pathlib import Path

from benchmark.errors import InputError

RESULT_FILES = (
    "results.json", "fit.json", "discovery.json", "verification.json", "report.json", "reproduce.json",
)  # fmt: skip


def destination(out: Path | None, name: str) -> Path:
    """Return the folder for the result called `name`: `out`, or `results/NAME-DATE-TIME`.

    An earlier result of ours at `out` will be replaced once the new one is complete. Anything else there is refused,
    since replacing it would lose it.

    Raises
    ------
    InputError
        `out` is a file, or a folder with something else in it.
    """
    if out is None:
        return fresh(name)
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out} is a file; it must be a folder that is new, empty, or an earlier result")
    if out.is_dir() and any(out.iterdir()) and not any((out / file).is_file() for file in RESULT_FILES):
        raise InputError(
            f"--out {out} holds files that are not a result of this program; "
            "it must be a folder that is new, empty, or an earlier result"
        )
    return out


def fresh(name: str) -> Path:
    """Return `results/NAME-DATE-TIME`, which does not exist yet."""
    return _fresh(Path("results"), f"{file_name(name)}-{datetime.now():%Y%m%d-%H%M%S}")


def _fresh(parent: Path, name: str) -> Path:
    """Return a path in `parent` that does not exist yet."""
    candidates = [parent / name, *(parent / f"{name}-{number}" for number in range(2, 1000))]
    return next(path for path in candidates if not path.exists())


def file_name(name: str) -> str:
    """Return `name` with everything that file systems dislike replaced."""
    return re.sub(r"[^A-Za-z0-9._-]+", "-", name).strip("-.") or "run"
