"""Standard streams that are closed, broken or full: no file of ours takes their place, and each fault is told.

A program may be started with its standard input, output or error closed. The next file it opens then has the number of
that stream, and what a library says there would stand in the file. Nothing heavy is imported here.
"""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from typing import Any, TextIO

EXIT_UNSAID = 2


class _Raw(io.FileIO):
    """A standard stream that keeps the fault it met; one that is `deaf` goes on as if nothing had happened."""

    def __init__(self, handle: int, *, deaf: bool) -> None:
        super().__init__(handle, "w", closefd=False)
        self.fault: OSError | None = None
        self._deaf = deaf

    def write(self, data: Any, /) -> int:
        try:
            return super().write(data)
        except OSError as error:
            self.fault = error
            if self._deaf:
                return memoryview(data).nbytes
            raise


def open_streams() -> None:
    """Open closed standard streams onto nothing; no command fails by words that standard error cannot take."""
    for handle in range(3):
        try:
            os.fstat(handle)
        except OSError:
            _onto_nothing(handle)
    if sys.stdin is None:
        sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stdout = _wrapped(sys.stdout, _Raw(1, deaf=False))
    sys.stderr = _wrapped(sys.stderr, _Raw(2, deaf=True), line_buffering=True)


def _wrapped(old: TextIO | None, raw: _Raw, *, line_buffering: bool = False) -> TextIO:
    """A text stream as Python makes it, over `raw`."""
    return io.TextIOWrapper(
        io.BufferedWriter(raw),
        encoding="utf-8" if old is None else old.encoding,
        errors="backslashreplace" if old is None else old.errors,
        line_buffering=line_buffering or raw.isatty(),
        write_through=bool(getattr(old, "write_through", False)),
    )


def end(code: int) -> int:
    """Pass on what is left for standard output, and give the exit code: 2, and why, where that cannot be done."""
    known = unsaid() is not None
    with suppress(OSError, ValueError):
        sys.stdout.flush()
    fault = unsaid()
    if fault is None:
        return code
    _onto_nothing(1)  # or Python would fail by it again at its very end
    if not known or not code:
        print(f"error: {fault}", file=sys.stderr)
    return code or EXIT_UNSAID


def unsaid() -> str | None:
    """In words, what kept standard output from being written; None where nothing did."""
    stream = getattr(sys.stdout, "wrapped", sys.stdout)  # the command-line library wraps a broken pipe
    fault = getattr(getattr(getattr(stream, "buffer", None), "raw", None), "fault", None)
    if fault is None:
        return None
    return f"standard output cannot be written: {fault.strerror}; results that are in their place stay there"


def _onto_nothing(handle: int) -> None:
    nothing = os.open(os.devnull, os.O_RDWR)
    if nothing != handle:
        os.dup2(nothing, handle)
        os.close(nothing)
