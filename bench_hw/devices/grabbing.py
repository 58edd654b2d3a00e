"""Frames of a camera: their numbers, the thread that waits for the next one, and what webcam drivers share.

A camera that numbers its frames is believed. For one that does not, a gap of more than 1.5 periods between two stamps
is dropped frames, as many as fit. A frame that equals the one before byte for byte is frozen: a live sensor has noise.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import NamedTuple

from bench_hw.devices.protocols import CameraHealth, Frame
from bench_hw.errors import DeviceError

LARGEST_GAP = 1.5
"""Periods between two stamps above which frames were dropped."""


class FrameCounter:
    """Numbers the frames of one stream.

    Parameters
    ----------
    period : float
        Nominal time between two frames, s.
    """

    def __init__(self, period: float) -> None:
        self._period = period
        self._last: Frame | None = None
        self._offset: int | None = None
        self._received = self._dropped = self._frozen = 0

    @property
    def health(self) -> CameraHealth:
        """The counts so far."""
        return CameraHealth(self._received, self._dropped, self._frozen)

    def frame(self, time: float, data: bytes, format: str, sequence: int | None = None) -> Frame:
        """Give one frame its number; `sequence` is the camera's own number, if it has one."""
        number = self._number(time, sequence)
        last = self._last
        if last is not None:
            self._dropped += number - last.number - 1
            self._frozen += data == last.data
        self._received += 1
        self._last = Frame(time, number, data, format)
        return self._last

    def _number(self, time: float, sequence: int | None) -> int:
        if self._last is None:
            self._offset = sequence
            return 0
        if sequence is not None and self._offset is not None:
            return max(sequence - self._offset, self._last.number + 1)
        gap = time - self._last.time
        periods = round(gap / self._period) if gap > LARGEST_GAP * self._period else 1
        return self._last.number + periods


_JOIN_TIMEOUT = 2.0


class Taken(NamedTuple):
    """A frame as taken: stamp (s), encoded picture and the camera's own number, if it has one."""

    time: float
    data: bytes
    sequence: int | None = None


class Grabber:
    """Takes frames until it is stopped.

    Parameters
    ----------
    take : callable
        Waits for the next frame and gives it; None for one that could not be decoded; raises at the end.
    period : float
        Nominal time between two frames, s.
    where : str
        Name of the camera, for messages.
    """

    def __init__(self, take: Callable[[], Taken | None], period: float, where: str) -> None:
        self._take, self._where = take, where
        self._counter = FrameCounter(period)
        self._frames: list[Frame] = []
        self._lock = threading.Lock()
        self._error = ""
        self._running = threading.Event()
        self._running.set()
        self._thread = threading.Thread(target=self._run, name=where, daemon=True)
        self._thread.start()

    @property
    def health(self) -> CameraHealth:
        """Counts since the start."""
        return self._counter.health

    def read(self) -> list[Frame]:
        """Give the frames taken since the last call; never waits.

        Raises
        ------
        DeviceError
            There are none left and the camera ended.
        """
        with self._lock:
            frames, self._frames = self._frames, []
        if not frames and self._error:
            raise DeviceError(f"{self._where}: {self._error}")
        return frames

    def stop(self) -> None:
        """Take no more."""
        self._running.clear()
        self._thread.join(timeout=_JOIN_TIMEOUT)

    def _run(self) -> None:
        try:
            while self._running.is_set():
                taken = self._take()
                if taken is not None:
                    frame = self._counter.frame(taken.time, taken.data, "jpeg", taken.sequence)
                    with self._lock:
                        self._frames.append(frame)
        except Exception as error:  # whatever the camera's library raises ends the stream, not the program
            self._error = str(error) or type(error).__name__
