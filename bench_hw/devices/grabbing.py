"""Frames of a camera: their numbers, the thread that waits for the next one, and what webcam drivers share.

A camera that numbers its frames is believed. For one that does not, a gap of more than 1.5 periods between two stamps
is dropped frames, as many as fit. A frame that equals the one before byte for byte is frozen: a live sensor has noise.
"""

from __future__ import annotations

import threading
from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from bench_hw.clock import Clock, MonotonicClock
from bench_hw.devices.protocols import CameraFrame, CameraHealth, Connection, DeviceInfo
from bench_hw.errors import DeviceError

LARGEST_GAP = 1.5
"""Periods between two stamps above which frames were dropped."""
LOCKED: Mapping[str, float] = {"exposure": 156.0, "focus": 60.0, "white_balance": 4500.0}
"""Values a webcam is locked at unless the rig says others (V4L2 units: 0.1 ms, steps, kelvin)."""
STAMP_TOLERANCE = 0.5
"""A camera's own stamp is believed if it is at most this old when the frame is taken, s."""
_JOIN_TIMEOUT = 2.0


class FrameCounter:
    """Numbers the frames of one stream.

    Parameters
    ----------
    period : float
        Nominal time between two frames, s.
    """

    def __init__(self, period: float) -> None:
        self._period = period
        self._last: CameraFrame | None = None
        self._offset: int | None = None
        self._received = self._dropped = self._frozen = 0

    @property
    def health(self) -> CameraHealth:
        """The counts so far."""
        return CameraHealth(self._received, self._dropped, self._frozen)

    def frame(self, time: float, data: bytes, format: str, sequence: int | None = None) -> CameraFrame:
        """Give one frame its number; `sequence` is the camera's own number, if it has one."""
        number = self._number(time, sequence)
        last = self._last
        if last is not None:
            self._dropped += number - last.number - 1
            self._frozen += data == last.data
        self._received += 1
        self._last = CameraFrame(time, number, data, format)
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
        self._frames: list[CameraFrame] = []
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

    def read(self) -> list[CameraFrame]:
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


class GrabbedCamera(Connection):
    """What webcam drivers share: settings that are locked and read back, and a `Grabber` from `start` to `stop`.

    Parameters
    ----------
    name : str
        Of the camera, for messages.
    rate : float
        Frames per second wanted, Hz.
    size : tuple of 2 ints
        Width and height wanted, pixels.
    controls : Mapping[str, float] or None
        Values to lock `exposure`, `focus` and `white_balance` at, in the camera's own units; None for `LOCKED`.
    clock : Clock or None
        The bench's clock.
    """

    def __init__(
        self,
        name: str,
        rate: float,
        size: tuple[int, int],
        controls: Mapping[str, float] | None,
        clock: Clock | None,
    ) -> None:
        self._where, self._rate, self._size = name, rate, size
        self._controls = LOCKED if controls is None else controls
        self._clock = clock or MonotonicClock()
        self._capture: Any = None
        self._settings: dict[str, str] = {}
        self._grabber: Grabber | None = None

    @property
    def info(self) -> DeviceInfo:
        """Name of the device and the settings as read back."""
        return DeviceInfo(self._where, settings=self._settings)

    @property
    def rate(self) -> float:
        """Frames per second wanted, Hz; what comes is recorded, not assumed."""
        return self._rate

    @property
    def health(self) -> CameraHealth:
        """Counts since `start`."""
        return CameraHealth() if self._grabber is None else self._grabber.health

    def start(self) -> None:
        """Begin to take frames in a thread; numbers begin at 0.

        Raises
        ------
        DeviceError
            Not connected.
        """
        if self._capture is None:
            raise DeviceError(f"{self._where}: not connected")
        self.stop()
        self._begin()
        self._grabber = Grabber(self._take, 1.0 / self._rate, self._where)

    def read(self) -> list[CameraFrame]:
        """Give the frames taken since the last call; never waits.

        Raises
        ------
        DeviceError
            The camera stopped giving frames.
        """
        return [] if self._grabber is None else self._grabber.read()

    def stop(self) -> None:
        """Stop taking frames."""
        if self._grabber is not None:
            self._grabber.stop()

    @abstractmethod
    def _begin(self) -> None:
        """Make the opened camera stream."""

    @abstractmethod
    def _take(self) -> Taken | None:
        """Wait for the next frame; None for one that could not be decoded."""

    def _checked_size(self, width: int, height: int) -> str:
        """Refuse another size than the rig asks for; give it in words."""
        if (width, height) != tuple(self._size):
            wanted = f"{self._size[0]} x {self._size[1]}"
            raise DeviceError(f"{self._where}: gives {width} x {height} pixels; the rig asks for {wanted}")
        return f"{width} x {height}"
