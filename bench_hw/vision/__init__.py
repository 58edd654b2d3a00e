"""From pictures to displacements: camera, calibration, frames, markers, tracking, displacement.

`camera` is the optical model, without any picture; `calibration` finds it from pictures of a board; `frames`
gives the pictures of a trial or video one after the other; `markers` finds markers in one picture; `tracking` follows
them from picture to picture; `displacement` turns tracks into what the rest of the product compares.
Nothing is imported here: take what is needed from the rooms.
"""

from __future__ import annotations

import os
from collections.abc import Callable

Progress = Callable[[int, int | None], None]
"""Called after each picture with how many are done and how many there should be, None if unknown."""


MOST_PIXELS = 1 << 28
"""Pixels of the largest picture that is decoded; OpenCV reads this limit when it is loaded."""
os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(MOST_PIXELS))


def silence_opencv() -> None:
    """Silence what OpenCV's libraries print to standard error when a file is broken, for this process.

    Every one of these messages comes back as an error or a warning of the bench. For command lines; a library leaves
    this to its user. Must come before the first video is opened.
    """
    import cv2

    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
