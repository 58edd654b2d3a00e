"""`WebcamCamera`: a webcam through OpenCV, with everything locked that would move by itself.

Exposure, white balance and focus are fixed and read back: a lens that focuses by itself changes the millimetres per
pixel. OpenCV's own time stamps have a history of errors, so they are used only while they are positive, increasing and
close to the bench's clock; otherwise a frame is stamped right after `grab()`. A camera that delivers MJPG is recorded
as its own JPEG bytes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from bench_hw.clock import Clock, MonotonicClock
from bench_hw.devices.grabbing import Grabber, Taken
from bench_hw.devices.protocols import CameraHealth, Connection, DeviceInfo, Frame
from bench_hw.errors import DeviceError

LOCKED: Mapping[str, float] = {"exposure": 156.0, "focus": 60.0, "white_balance": 4500.0}
"""Values a webcam is locked at unless the rig says others (V4L2 units: 0.1 ms, steps, kelvin)."""
_MANUAL_EXPOSURE = 1.0
_TOLERANCE = 0.02


def open_device(device: int | str) -> Any:
    """Open a camera by number (V4L2 on Linux), or a stream or file by name."""
    import sys

    import cv2

    backend = cv2.CAP_V4L2 if isinstance(device, int) and sys.platform == "linux" else cv2.CAP_ANY
    return cv2.VideoCapture(device, backend)


def set_up(capture: Any, where: str, size: tuple[int, int], rate: float) -> dict[str, str]:
    """Ask for MJPG, size and rate; give what reads back.

    Raises
    ------
    DeviceError
        The size reads back as another one.
    """
    import cv2

    capture.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter.fourcc(*"MJPG"))
    capture.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
    capture.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])
    capture.set(cv2.CAP_PROP_FPS, rate)
    capture.set(cv2.CAP_PROP_CONVERT_RGB, 0)
    found = (int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)), int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT)))
    if found != tuple(size):
        raise DeviceError(f"{where}: gives {found[0]} x {found[1]} pixels; the rig asks for {size[0]} x {size[1]}")
    return {"size": f"{found[0]} x {found[1]}", "rate": f"{capture.get(cv2.CAP_PROP_FPS):g} Hz"}


def lock(capture: Any, where: str, controls: Mapping[str, float]) -> dict[str, str]:
    """Switch the automatics off, set each control and read it back.

    Raises
    ------
    DeviceError
        A control is unknown, or does not read back within 2 %.
    """
    return {name: _lock_one(capture, where, name, value) for name, value in controls.items()}


def _lock_one(capture: Any, where: str, name: str, value: float) -> str:
    import cv2

    known = {
        "exposure": (cv2.CAP_PROP_AUTO_EXPOSURE, _MANUAL_EXPOSURE, cv2.CAP_PROP_EXPOSURE),
        "focus": (cv2.CAP_PROP_AUTOFOCUS, 0.0, cv2.CAP_PROP_FOCUS),
        "white_balance": (cv2.CAP_PROP_AUTO_WB, 0.0, cv2.CAP_PROP_WB_TEMPERATURE),
    }
    if name not in known:
        raise DeviceError(f"{where}: control {name!r}; allowed are {', '.join(known)}")
    automatic, off, control = known[name]
    capture.set(automatic, off)
    capture.set(control, value)
    found_automatic, found = float(capture.get(automatic)), float(capture.get(control))
    if found_automatic != off or abs(found - value) > _TOLERANCE * max(1.0, abs(value)):
        raise DeviceError(
            f"{where}: {name} cannot be locked at {value:g} (reads back {found:g}, "
            f"automatic {found_automatic:g}); choose another value under [camera.controls], or leave {name} out there"
        )
    return f"{found:g}"


_STAMP_TOLERANCE = 0.5
_JPEG_QUALITY = 95
_JPEG_START = b"\xff\xd8"


class WebcamCamera(Connection):
    """Driver of a webcam.

    Parameters
    ----------
    device : int or str
        Number of the camera, or anything else `cv2.VideoCapture` opens.
    rate : float
        Frames per second wanted, Hz.
    size : tuple of 2 ints
        Width and height wanted, pixels.
    controls : Mapping[str, float], optional
        Values to lock `exposure`, `focus` and `white_balance` at, in the camera's own units; {} locks nothing
        (a stream or a file has no controls).
    open_capture : callable, optional
        Gives an opened `cv2.VideoCapture` for `device`.
    clock : Clock, optional
        The bench's clock.
    """

    def __init__(
        self,
        device: int | str = 0,
        *,
        rate: float = 30.0,
        size: tuple[int, int] = (640, 480),
        controls: Mapping[str, float] | None = None,
        open_capture: Callable[[int | str], Any] = open_device,
        clock: Clock | None = None,
    ) -> None:
        self._device, self._rate, self._size = device, rate, size
        self._controls = LOCKED if controls is None else controls
        self._open_capture = open_capture
        self._clock = clock or MonotonicClock()
        self._capture: Any = None
        self._settings: dict[str, str] = {}
        self._grabber: Grabber | None = None
        self._last = -math.inf

    @property
    def info(self) -> DeviceInfo:
        """Name of the device and the settings as read back."""
        return DeviceInfo(self._where(), settings=self._settings)

    @property
    def rate(self) -> float:
        """Frames per second wanted, Hz; what comes is recorded, not assumed."""
        return self._rate

    @property
    def health(self) -> CameraHealth:
        """Counts since `start`."""
        return CameraHealth() if self._grabber is None else self._grabber.health

    def connect(self) -> None:
        """Open the camera, set size and rate, lock the controls, read all back and take one frame.

        Raises
        ------
        DeviceError
            No such camera, another size, a control that does not read back, or no picture.
        """
        self.close()
        self._capture = self._open_capture(self._device)
        try:
            if not self._capture.isOpened():
                raise DeviceError(f"{self._where()}: cannot be opened; check the cable and that nothing else uses it")
            self._settings = set_up(self._capture, self._where(), self._size, self._rate)
            self._settings |= lock(self._capture, self._where(), self._controls)
            if not self._capture.grab():
                raise DeviceError(f"{self._where()}: gives no picture")
        except BaseException:
            self.close()
            raise

    def start(self) -> None:
        """Begin to grab in a thread; numbers begin at 0.

        Raises
        ------
        DeviceError
            Not connected.
        """
        if self._capture is None:
            raise DeviceError(f"{self._where()}: not connected")
        self.stop()
        self._last = -math.inf
        self._grabber = Grabber(self._take, 1.0 / self._rate, self._where())

    def read(self) -> list[Frame]:
        """Give the frames grabbed since the last call; never waits.

        Raises
        ------
        DeviceError
            The camera stopped giving pictures.
        """
        return [] if self._grabber is None else self._grabber.read()

    def stop(self) -> None:
        """Stop grabbing."""
        if self._grabber is not None:
            self._grabber.stop()

    def close(self) -> None:
        """Stop and release the camera; may be repeated."""
        self.stop()
        if self._capture is not None:
            self._capture.release()
            self._capture = None

    def _take(self) -> Taken | None:
        if not self._capture.grab():
            raise DeviceError("lost (unplugged?)")
        after = self._clock.now()
        data = self._encoded()
        if data is None:
            return None
        self._last = self._stamp(after)
        return Taken(self._last, data)

    def _stamp(self, after_grab: float) -> float:
        import cv2

        own = float(self._capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0
        plausible = own > max(0.0, self._last) and after_grab - _STAMP_TOLERANCE < own <= after_grab
        return own if plausible else after_grab

    def _encoded(self) -> bytes | None:
        import cv2

        good, picture = self._capture.retrieve()
        if not good or picture is None:
            return None
        flat = np.asarray(picture).reshape(-1)
        if min(picture.shape[:2]) == 1 and flat[:2].tobytes() == _JPEG_START:
            return flat.tobytes()
        return bytes(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])[1])

    def _where(self) -> str:
        return f"webcam {self._device}"
