"""OpenCV's own messages: what its libraries print to standard error when a file is broken."""

from __future__ import annotations

import os


def hush() -> None:
    """Silence them for this process; every one of them comes back as an error or a warning of the bench.

    For command lines; a library leaves this to its user. Must come before the first video is opened.
    """
    import cv2

    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
