"""Where a model may keep unfinished work."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Keeping:
    """A folder for unfinished work, which need not exist yet, and who is told what was found or done there."""

    folder: Path
    say: Callable[[str], None]
