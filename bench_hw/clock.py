"""The one monotonic clock of a bench, real or simulated.

Every driver, twin and recorder takes its clock as an argument. With `MonotonicClock` the bench runs in real
time; with `SimulatedClock` nothing sleeps: a wait moves time on, and the twins that subscribed do
their work at each step, so a session of minutes takes seconds and tests wait for nothing.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Protocol

_SETTLE = 0.05

Tick = Callable[[float], None]
"""Called with the clock's reading, s."""


Cancel = Callable[[], None]
"""Ends a repetition started with `Clock.every`."""


class Clock(Protocol):
    """A monotonic clock in seconds that can be waited on and that can call back."""

    def now(self) -> float:
        """Give the reading, s; it never decreases."""
        ...

    def sleep(self, duration: float) -> None:
        """Let `duration` seconds pass on this clock; nothing if it is not positive."""
        ...

    def settle(self) -> None:
        """Let arrive what is under way between processes and threads; takes no time of this clock."""
        ...

    def every(self, period: float, tick: Tick) -> Cancel:
        """Call `tick(now)` about every `period` seconds of this clock until the result is called."""
        ...


class MonotonicClock:
    """Real time: `time.monotonic`; repetitions run in a thread each."""

    def now(self) -> float:
        """Give the reading of `time.monotonic`, s."""
        return time.monotonic()

    def sleep(self, duration: float) -> None:
        """Sleep in real time."""
        if duration > 0.0:
            time.sleep(duration)

    def settle(self) -> None:
        """Do nothing: in real time what is under way is late."""

    def every(self, period: float, tick: Tick) -> Cancel:
        """Call `tick` from a daemon thread every `period` seconds; the result stops and joins it."""
        stopped = threading.Event()

        def loop() -> None:
            while not stopped.wait(period):
                tick(self.now())

        thread = threading.Thread(target=loop, name=f"every-{period:g}s", daemon=True)
        thread.start()

        def cancel() -> None:
            stopped.set()
            if thread is not threading.current_thread():
                thread.join(timeout=5.0)

        return cancel


class SimulatedClock:
    """Time that passes only during `sleep`; single-threaded and repeatable.

    Parameters
    ----------
    start : float
        First reading, s.
    step : float
        Longest stretch of time (s) that passes between two rounds of call-backs.
    """

    def __init__(self, start: float = 0.0, step: float = 1e-3) -> None:
        if not step > 0.0:
            raise ValueError(f"step = {step} s: allowed are positive values")
        self._now = start
        self._step = step
        self._ticks: list[Tick] = []

    def now(self) -> float:
        """Give the reading, s."""
        return self._now

    def sleep(self, duration: float) -> None:
        """Move time on by `duration`, calling back at least every `step` seconds on the way."""
        if duration <= 0.0:
            return
        end = self._now + duration
        while self._now < end:
            left = end - self._now
            self._now = end if left <= self._step * (1.0 + 1e-9) else self._now + self._step
            for tick in tuple(self._ticks):
                tick(self._now)

    def settle(self) -> None:
        """Wait a moment of real time: a busy machine may deliver later than simulated time runs."""
        time.sleep(_SETTLE)

    def every(self, period: float, tick: Tick) -> Cancel:  # noqa: ARG002 - the step is the period here
        """Call `tick` at every step of this clock until the result is called."""
        self._ticks.append(tick)

        def cancel() -> None:
            if tick in self._ticks:
                self._ticks.remove(tick)

        return cancel


def wait_until(clock: Clock, ready: Callable[[], bool], timeout: float, interval: float = 1e-3) -> bool:
    """Sleep in steps of `interval` until `ready()` is true; False if that takes longer than `timeout` s."""
    deadline = clock.now() + timeout
    while not ready():
        if clock.now() >= deadline:
            clock.settle()
            return ready()
        clock.sleep(interval)
    return True
