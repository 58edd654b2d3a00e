"""What was tried so far, a line of JSON for each try, so that a torture that was stopped goes on where it was."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any


class Journal:
    """Tries on file: written as they come, read when the torture begins again.

    Parameters
    ----------
    path : pathlib.Path or None
        The file, which is made; None keeps them in memory alone. A last line that was cut is passed over.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._path, self._entries = path, list[dict[str, Any]]()
        if path is not None and path.exists():
            self._entries = [json.loads(line) for line in path.read_text().split("\n")[:-1]]

    def of(self, part: str) -> list[dict[str, Any]]:
        """The tries of a part, in their order."""
        return [each for each in self._entries if each["part"] == part]

    def add(self, part: str, **entry: Any) -> None:
        """Keep a try."""
        found = {"part": part, **entry}
        self._entries.append(found)
        if self._path is not None:
            with self._path.open("a") as stream:
                stream.write(json.dumps(found) + "\n")
                stream.flush()
                os.fsync(stream.fileno())
