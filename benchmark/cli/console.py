"""What the command line says while it works: rich progress on a terminal, plain lines otherwise.

Everything here goes to stderr, so that stdout carries results alone.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

Advance = Callable[[str, int, int, str], None]


def _silent(*_: object) -> None:
    """Show nothing."""


class Console:
    """Progress and remarks; silent with `quiet`."""

    def __init__(self, *, quiet: bool, stream: TextIO | None = None):
        self._quiet = quiet
        self._stream = sys.stderr if stream is None else stream

    def say(self, text: str) -> None:
        """Print one line."""
        if not self._quiet:
            print(text, file=self._stream, flush=True)

    @contextmanager
    def progress(self, title: str) -> Iterator[Advance]:
        """Yield `advance(task, done, total, remark)`: a bar a task on a terminal, a line a quarter otherwise."""
        if self._quiet:
            yield _silent
        elif self._stream.isatty():
            with self._bars(title) as advance:
                yield advance
        else:
            self.say(title)
            yield self._lines()

    @contextmanager
    def _bars(self, title: str) -> Iterator[Advance]:
        from rich.console import Console as RichConsole
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("{task.fields[remark]}"),
        )
        self.say(title)
        with Progress(*columns, console=RichConsole(file=self._stream)) as progress:
            tasks = {}

            def advance(task: str, done: int, total: int, remark: str) -> None:
                if task not in tasks:
                    tasks[task] = progress.add_task(task, total=total, remark="")
                progress.update(tasks[task], completed=done, total=total, remark=remark)

            yield advance

    def _lines(self) -> Advance:
        """One line at each quarter of a task."""
        said: dict[str, int] = {}

        def advance(task: str, done: int, total: int, remark: str) -> None:
            quarter = 4 * done // max(total, 1)
            if quarter > said.get(task, 0):
                said[task] = quarter
                self.say(f"  {task}: {done}/{total} {remark}".rstrip())

        return advance
