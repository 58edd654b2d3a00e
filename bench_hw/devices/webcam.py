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

from bench_hw.clock import Clock
from bench_hw.devices.grabbing import STAMP_TOLERANCE, GrabbedCamera, Taken
from bench_hw.errors import DeviceError

_MANUAL_EXPOSURE = 1.0
_TOLERANCE = 0.02
_JPEG_QUALITY = 95
_JPEG_START = b"\xff\xd8"


def open_device(device: int | str) -> Any:
    """Open a camera by number (V4L2 on Linux), or a stream or file by name."""
    import sys

    import cv2

    backend = cv2.CAP_V4L2 if isinstance(device, int) and sys.platform == "linux" else cv2.CAP_ANY
    return cv2.VideoCapture(device, backend)


class WebcamCamera(GrabbedCamera):
    """Driver of a webcam.

    Parameters
    ----------
    device : int or str
        Number of the camera, or anything else `cv2.VideoCapture` opens.
    rate, size, controls, clock
        As in `GrabbedCamera`; controls {} locks nothing (a stream or a file has no controls).
    open_capture : callable, optional
        Gives an opened `cv2.VideoCapture` for `device`.
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
        super().__init__(f"webcam {device}", rate, size, controls, clock)
        self._device, self._open_capture = device, open_capture
        self._last = -math.inf

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
                raise DeviceError(f"{self._where}: cannot be opened; check the cable and that nothing else uses it")
            self._settings = self._set_up() | {name: self._lock(name, value) for name, value in self._controls.items()}
            if not self._capture.grab():
                raise DeviceError(f"{self._where}: gives no picture")
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Stop and release the camera; may be repeated."""
        self.stop()
        if self._capture is not None:
            self._capture.release()
            self._capture = None

    def _set_up(self) -> dict[str, str]:
        """Ask for MJPG, size and rate; give what reads back."""
        import cv2

        capture = self._capture
        capture.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter.fourcc(*"MJPG"))
        capture.set(cv2.CAP_PROP_FRAME_WIDTH, self._size[0])
        capture.set(cv2.CAP_PROP_FRAME_HEIGHT, self._size[1])
        capture.set(cv2.CAP_PROP_FPS, self._rate)
        capture.set(cv2.CAP_PROP_CONVERT_RGB, 0)
        found = (int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)), int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT)))
        return {"size": self._checked_size(*found), "rate": f"{capture.get(cv2.CAP_PROP_FPS):g} Hz"}

    def _lock(self, name: str, value: float) -> str:
        """Switch an automatic off, set its control and read it back within 2 %."""
        import cv2

        known = {
            "exposure": (cv2.CAP_PROP_AUTO_EXPOSURE, _MANUAL_EXPOSURE, cv2.CAP_PROP_EXPOSURE),
            "focus": (cv2.CAP_PROP_AUTOFOCUS, 0.0, cv2.CAP_PROP_FOCUS),
            "white_balance": (cv2.CAP_PROP_AUTO_WB, 0.0, cv2.CAP_PROP_WB_TEMPERATURE),
        }
        if name not in known:
            raise DeviceError(f"{self._where}: control {name!r}; allowed are {', '.join(known)}")
        automatic, off, control = known[name]
        self._capture.set(automatic, off)
        self._capture.set(control, value)
        found_automatic, found = (float(self._capture.get(which)) for which in (automatic, control))
        if found_automatic != off or abs(found - value) > _TOLERANCE * max(1.0, abs(value)):
            raise DeviceError(
                f"{self._where}: {name} cannot be locked at {value:g} (reads back {found:g}, automatic "
                f"{found_automatic:g}); choose another value under [camera.controls], or leave {name} out there"
            )
        return f"{found:g}"

    def _begin(self) -> None:
        self._last = -math.inf

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
        plausible = own > max(0.0, self._last) and after_grab - STAMP_TOLERANCE < own <= after_grab
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
