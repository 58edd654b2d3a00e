"""What was found, drawn into the pictures: a video to check by eye, and one still for the report."""

from __future__ import annotations

import math
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.storage.atomic import write_bytes
from bench_hw.vision.markers.grid import FloatArray, Picture, Sighting

_GREEN, _RED, _BLUE, _AMBER = (60, 180, 0), (40, 40, 220), (200, 110, 0), (0, 140, 255)
_SHIFT = 4
_FONT = cv2.FONT_HERSHEY_SIMPLEX
_USUAL_RATE = 30.0


def draw(grey: Picture, sighting: Sighting, rest: FloatArray, label: str = "") -> NDArray[np.uint8]:
    """Draw the markers into a picture.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture.
    sighting : Sighting
        Circles of the markers' areas, green, amber below a confidence of 0.9, with their numbers.
    rest : ndarray, shape (m, 2)
        Where the markers were at first, pixels: a line from there to where each is, a red cross for one that is
        not seen.
    label : str
        Written into the corner.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        Blue, green, red.
    """
    picture = cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR)
    for marker, (begin, seen) in enumerate(zip(rest, sighting.seen, strict=True)):
        if not seen:
            cv2.drawMarker(picture, _whole(begin), _RED, cv2.MARKER_TILTED_CROSS, 14, 1, cv2.LINE_AA)
            continue
        place, radius = sighting.pixels[marker], sighting.radius[marker]
        colour = _GREEN if sighting.confidence[marker] >= 0.9 else _AMBER
        cv2.line(picture, _fine(begin), _fine(place), _BLUE, 1, cv2.LINE_AA, _SHIFT)
        cv2.circle(picture, _fine(place), round(radius * 2**_SHIFT), colour, 1, cv2.LINE_AA, _SHIFT)
        text = _whole(place + np.array([radius + 2.0, -radius]))
        cv2.putText(picture, str(marker), text, _FONT, 0.4, colour, 1, cv2.LINE_AA)
    if label:
        cv2.putText(picture, label, (6, 14), _FONT, 0.4, _BLUE, 1, cv2.LINE_AA)
    return np.asarray(picture, dtype=np.uint8)


def _whole(point: FloatArray) -> tuple[int, int]:
    return round(float(point[0])), round(float(point[1]))


def _fine(point: FloatArray) -> tuple[int, int]:
    return round(float(point[0]) * 2**_SHIFT), round(float(point[1]) * 2**_SHIFT)


class OverlayVideo:
    """An overlay being written (Motion JPEG in AVI)."""

    def __init__(self, path: Path, rate: float, size: tuple[int, int]) -> None:
        code = cv2.VideoWriter.fourcc(*"MJPG")
        self._writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, code, rate, size)
        if not self._writer.isOpened():
            raise InputError(f"{path}: the overlay video cannot be written; allowed: a name that ends in .avi")

    def write(self, picture: NDArray[np.uint8]) -> None:
        """Add a picture."""
        self._writer.write(picture)

    def close(self) -> None:
        """Write the end of the file."""
        self._writer.release()


@contextmanager
def overlay_video(path: Path | None, rate: float | None, size: tuple[int, int]) -> Iterator[OverlayVideo | None]:
    """Open an overlay that appears whole when the block ends well, and not at all otherwise; None without a path.

    Raises
    ------
    InputError
        The name does not end in .avi, or the folder cannot be written.
    """
    if path is None:
        yield None
        return
    if path.suffix.lower() != ".avi":
        raise InputError(f"{path}: an overlay is Motion JPEG; allowed: a name that ends in .avi")
    path.parent.mkdir(parents=True, exist_ok=True)
    folder = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")  # where a kill leaves it, `clean` knows it
    folder.mkdir()
    try:
        video = OverlayVideo(folder / path.name, rate or _USUAL_RATE, size)
        try:
            yield video
        finally:
            video.close()
        (folder / path.name).replace(path)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


class Still:
    """Keeps the drawing of the picture in which the markers have moved farthest from where they began."""

    def __init__(self, rest: FloatArray) -> None:
        self._rest, self._farthest = rest, -math.inf
        self._kept: tuple[Picture, Sighting, str] | None = None

    def offer(self, grey: Picture, sighting: Sighting, label: str) -> None:
        """Keep a picture if it is the farthest so far; one with half the markers unseen is not."""
        seen = sighting.seen
        if seen.mean() <= 0.5:
            return
        moved = float(np.hypot(*(sighting.pixels - self._rest)[seen].T).mean())
        if moved > self._farthest:
            self._farthest, self._kept = moved, (grey, sighting, label)

    def write(self, path: Path) -> Path:
        """Write it as PNG, whole or not at all.

        Raises
        ------
        InputError
            The name does not end in .png, or there was no picture.
        """
        if path.suffix.lower() != ".png" or self._kept is None:
            raise InputError(f"{path}: no still; allowed: a name that ends in .png, and a video with its markers in it")
        grey, sighting, label = self._kept
        _, data = cv2.imencode(".png", draw(grey, sighting, self._rest, label))
        return write_bytes(path, data.tobytes())
