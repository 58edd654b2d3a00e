"""A thread that takes frames from a camera whose only way is to wait for the next one."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import NamedTuple

from bench_hw.devices.frame_count import FrameCounter
from bench_hw.devices.protocols import CameraHealth, Frame
from bench_hw.errors import DeviceError

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
