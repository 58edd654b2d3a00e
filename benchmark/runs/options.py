"""How a run is carried out, as opposed to what is run, and who is told how it gets on."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol


@dataclass(frozen=True)
class RunOptions:
    """Options of `run`.

    Attributes
    ----------
    every_field
        Write the fields of each step instead of the peak's and the last one's.
    repeats
        Timed repeats of each model, at least 3.
    refine
        Run both models on coarser and finer levels as well.
    seed
        Of every random draw.
    export
        Input files for other codes to write beside the result, by their endings ("inp", "feb").
    keep
        Folder in which a long run keeps its steps until its result is written; None keeps nothing.
    """

    every_field: bool = False
    repeats: int = 3
    refine: bool = False
    seed: int = 0
    keep: Path | None = None
    export: tuple[str, ...] = ()


Advance = Callable[[str, int, int, str], None]


class Listener(Protocol):
    """Remarks and progress of a long piece of work."""

    def say(self, text: str) -> None:
        """One line."""
        ...

    def progress(self, title: str) -> AbstractContextManager[Advance]:
        """`advance(task, done, total, remark)` inside the context."""
        ...
