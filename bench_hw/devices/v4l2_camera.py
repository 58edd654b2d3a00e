"""`V4l2Camera`: a webcam through linuxpy (optional extra `v4l2`), which gives real frame numbers and stamps.

The kernel numbers the frames, so a dropped frame is known and not guessed, and stamps them on the monotonic
clock. Needs a camera that delivers MJPG; its own JPEG bytes are recorded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from typing import Any

from bench_hw.clock import Clock
from bench_hw.devices.grabbing import STAMP_TOLERANCE, GrabbedCamera, Taken
from bench_hw.errors import DeviceError

MISSING = "linuxpy is not installed: pip install 'tissuebench[v4l2]', or set driver = \"opencv\" under [camera]"
_AUTOMATICS = {
    "exposure": (("auto_exposure", "exposure_auto"), 1, ("exposure_time_absolute", "exposure_absolute")),
    "focus": (("focus_automatic_continuous", "focus_auto"), 0, ("focus_absolute",)),
    "white_balance": (
        ("white_balance_automatic", "white_balance_temperature_auto"),
        0,
        ("white_balance_temperature",),
    ),
}


def open_linuxpy(device: int | str) -> tuple[Any, Any]:
    """Give linuxpy's device and its capture for a camera by number or path.

    Raises
    ------
    DeviceError
        linuxpy is not installed.
    """
    try:
        from linuxpy.video.device import Device, VideoCapture
    except ImportError as error:
        raise DeviceError(MISSING) from error
    opened = Device.from_id(device) if isinstance(device, int) else Device(device)
    return opened, VideoCapture(opened)


class V4l2Camera(GrabbedCamera):
    """Driver of a webcam by V4L2.

    Parameters
    ----------
    device : int or str
        Number or path of the camera.
    rate, size, controls, clock
        As in `GrabbedCamera`.
    open_camera : callable, optional
        Gives linuxpy's device and capture.
    """

    def __init__(
        self,
        device: int | str = 0,
        *,
        rate: float = 30.0,
        size: tuple[int, int] = (640, 480),
        controls: Mapping[str, float] | None = None,
        open_camera: Callable[[int | str], tuple[Any, Any]] = open_linuxpy,
        clock: Clock | None = None,
    ) -> None:
        super().__init__(f"webcam {device} (V4L2)", rate, size, controls, clock)
        self._device, self._open_camera = device, open_camera
        self._opened = ExitStack()
        self._frames: Iterator[Any] = iter(())

    def connect(self) -> None:
        """Open the camera, set size and rate, lock the controls and read all back.

        Raises
        ------
        DeviceError
            linuxpy is missing, there is no such camera, no MJPG in that size, or a control cannot be locked.
        """
        self.close()
        device, capture = self._open_camera(self._device)
        with ExitStack() as stack:
            try:
                stack.enter_context(device)
                capture.set_format(*self._size, "MJPG")
                capture.set_fps(self._rate)
                self._settings = self._read_back(capture) | {
                    name: self._lock(device, name, value) for name, value in self._controls.items()
                }
            except OSError as error:
                raise DeviceError(f"{self._where}: {error.strerror or error}") from error
            self._opened, self._capture = stack.pop_all(), capture

    def stop(self) -> None:
        """Stop taking frames."""
        if self._grabber is not None and self._capture is not None:
            self._grabber.stop()
            self._capture.close()

    def close(self) -> None:
        """Stop and close the camera; may be repeated."""
        self.stop()
        self._capture = None
        self._opened.close()

    def _begin(self) -> None:
        self._capture.open()
        self._frames = iter(self._capture)

    def _take(self) -> Taken:
        frame = next(self._frames)
        now = self._clock.now()
        own = float(frame.timestamp)
        return Taken(own if now - STAMP_TOLERANCE < own <= now else now, bytes(frame), int(frame.frame_nb))

    def _read_back(self, capture: Any) -> dict[str, str]:
        found = capture.get_format()
        return {"size": self._checked_size(found.width, found.height), "rate": f"{float(capture.get_fps()):g} Hz"}

    def _lock(self, device: Any, name: str, value: float) -> str:
        if name not in _AUTOMATICS:
            raise DeviceError(f"{self._where}: control {name!r}; allowed are {', '.join(_AUTOMATICS)}")
        automatics, off, controls = _AUTOMATICS[name]
        self._set(device, automatics, off)
        return f"{self._set(device, controls, round(value)):g}"

    def _set(self, device: Any, names: tuple[str, ...], value: int) -> float:
        for name in names:
            control = getattr(device.controls, name, None)
            if control is not None:
                control.value = value
                if int(control.value) != value:
                    raise DeviceError(
                        f"{self._where}: {name} cannot be set to {value} (reads back {control.value}); choose "
                        "another value under [camera.controls]"
                    )
                return float(control.value)
        raise DeviceError(f"{self._where}: has no control {' or '.join(names)}; leave it out of [camera.controls]")
