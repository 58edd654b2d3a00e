"""What a person sees while trials are recorded, and how they stop it.

A live line on a terminal, plain lines otherwise, or nothing; Ctrl-C as a flag that the capture looks at once a turn, so
that no exchange with a device is cut in two.
"""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TextIO

if TYPE_CHECKING:
    from rich.console import Console, RenderableType


_PLAIN_PERIOD = 1.0
_SIGNALS = (signal.SIGINT, signal.SIGTERM)


@dataclass(slots=True)
class CaptureState:
    """The state of the capture, brought up to date by its loop.

    Parameters
    ----------
    trial, trials : int
        Number of the trial and how many there are.
    doing : str
        What the tool does.
    elapsed, planned : float
        Time since the trial began and its planned length, s.
    depth, press : float
        m and N.
    lost : int
        Force records lost.
    camera : float or None
        Pictures per second over the last ones; None without a camera.
    dropped : int
        Pictures dropped.
    """

    trial: int = 0
    trials: int = 0
    doing: str = ""
    elapsed: float = 0.0
    planned: float = 0.0
    depth: float = 0.0
    press: float = 0.0
    lost: int = 0
    camera: float | None = None
    dropped: int = 0

    def line(self) -> str:
        """Say it in one line."""
        film = "" if self.camera is None else f"camera {self.camera:.1f}/s dropped {self.dropped}  "
        trial = f"trial {self.trial}/{self.trials} {self.elapsed:.1f}/{self.planned:.1f} s"
        return (
            f"{trial if self.trial else 'before the first trial'}  "
            f"depth {self.depth * 1e3:+.3f} mm  force {self.press:+.3f} N  {film}lost {self.lost}  {self.doing}"
        )


class ProgressDisplay(Protocol):
    """Something that shows snapshots; cheap, as it is called at every turn."""

    def update(self, snapshot: CaptureState) -> None:
        """Show a snapshot, or skip it."""
        ...

    def say(self, text: str) -> None:
        """Show one sentence."""
        ...

    def showing(self) -> AbstractContextManager[object]:
        """Give the context in which it shows."""
        ...


class Silent:
    """Shows nothing."""

    def update(self, snapshot: CaptureState) -> None:
        """Skip it."""

    def say(self, text: str) -> None:
        """Skip it."""

    def showing(self) -> AbstractContextManager[object]:
        """Give an empty context."""
        return nullcontext()


class PlainLines:
    """Writes a line for each second of a trial and for each new doing.

    Parameters
    ----------
    stream : TextIO, optional
        Where to; by default standard error.
    """

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream or sys.stderr
        self._shown: tuple[int, int] = (0, -1)

    def update(self, snapshot: CaptureState) -> None:
        """Write a line if another second of the trial has begun."""
        second = (snapshot.trial, int(snapshot.elapsed / _PLAIN_PERIOD))
        if second != self._shown:
            self._shown = second
            self.say(snapshot.line())

    def say(self, text: str) -> None:
        """Write one line."""
        print(text, file=self._stream, flush=True)

    def showing(self) -> AbstractContextManager[object]:
        """Give an empty context."""
        return nullcontext()


class TerminalLine:
    """One line on a terminal, two where it is narrow, redrawn eight times a second by rich's thread.

    Parameters
    ----------
    console : rich.console.Console, optional
        Where to; by default standard error.
    """

    def __init__(self, console: Console | None = None) -> None:
        from rich.console import Console
        from rich.live import Live

        self._snapshot = CaptureState()
        self._console = console or Console(stderr=True)
        self._live = Live(console=self._console, get_renderable=self._draw, refresh_per_second=8, redirect_stdout=False)

    def update(self, snapshot: CaptureState) -> None:
        """Remember it for the next drawing."""
        self._snapshot = snapshot

    def say(self, text: str) -> None:
        """Print one line above the live one."""
        self._console.print(text, highlight=False, markup=False)

    def showing(self) -> AbstractContextManager[object]:
        """Give the context in which the line is drawn."""
        return self._live

    def _draw(self) -> RenderableType:
        from rich.text import Text

        return Text(self._snapshot.line() if self._snapshot.trials else "")


def choose_progress(quiet: bool) -> ProgressDisplay:
    """Give what suits the place: nothing, a live line on a terminal, or plain lines."""
    if quiet:
        return Silent()
    return TerminalLine() if sys.stderr.isatty() else PlainLines()


class StopEvent(threading.Event):
    """Set to stop the capture; `by` says what asked for it."""

    by = "Ctrl-C"


def stopped_by(stop: threading.Event) -> str:
    """What set an event: a signal by its name, or Ctrl-C."""
    return stop.by if isinstance(stop, StopEvent) else StopEvent.by


@contextmanager
def stop_on_signals() -> Iterator[threading.Event]:
    """Give an event that SIGINT (Ctrl-C) and SIGTERM set; outside the main thread it is never set.

    A second signal raises `KeyboardInterrupt` wherever the program is, in case it hangs.
    """
    stop = StopEvent()

    def note(number: int, _: object) -> None:
        if stop.is_set():
            raise KeyboardInterrupt
        stop.by = "Ctrl-C" if number == signal.SIGINT else signal.Signals(number).name
        stop.set()

    if threading.current_thread() is not threading.main_thread():
        yield stop
        return
    before = {number: signal.signal(number, note) for number in _SIGNALS}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
