"""Who is told how a run gets on."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Protocol

Advance = Callable[[str, int, int, str], None]


class Listener(Protocol):
    """Remarks and progress of a long piece of work."""

    def say(self, text: str) -> None:
        """One line."""
        ...

    def progress(self, title: str) -> AbstractContextManager[Advance]:
        """`advance(task, done, total, remark)` inside the context."""
        ...
