"""The checks of a trial, each on disk as it ends."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.performance.gate_trial.copies import Check


class Log:
    """Checks so far, those of an earlier start of the same trial included.

    Parameters
    ----------
    path
        File with one JSON object a line; None keeps nothing.

    Attributes
    ----------
    rows : list of dict
        The checks, as `Check.to_dict`.
    """

    def __init__(self, path: Path | None):
        self._path = path
        lines = path.read_text(encoding="utf-8").splitlines() if path is not None and path.exists() else []
        self.rows: list[dict[str, Any]] = [json.loads(line) for line in lines]

    def checks_of(self, copy: str) -> int:
        """How many checks of a copy there are."""
        return sum(row["copy"] == copy for row in self.rows)

    def add(self, check: Check) -> None:
        """Say how a check ended, and keep it."""
        print(f"{check.copy}: exit {check.code} in {check.seconds:.0f} s", flush=True)
        self.rows.append(check.to_dict())
        if self._path is not None:
            with self._path.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(self.rows[-1]) + "\n")
