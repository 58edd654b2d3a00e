"""Setting a webcam up through OpenCV and reading back what became of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

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
