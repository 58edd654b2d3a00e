"""The pictures of a video file, through OpenCV's own FFmpeg."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.frames.decoding import to_grey
from bench_hw.vision.frames.model import Frame

_RATES = (0.01, 100_000.0)
_GREY = cv2.VideoWriter.fourcc(*"Y800")
"""FFmpeg's pixels of one byte of grey: they need no way through colour and back."""


class VideoFrames:
    """Pictures of a video.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    rate : float, optional
        Pictures per second instead of the file's own, Hz.

    Raises
    ------
    InputError
        No such file, no video, or one that does not say how fast it is.
    """

    def __init__(self, path: Path, rate: float | None = None) -> None:
        self._path = path
        if not path.is_file():
            raise InputError(f"{path}: no such file; allowed: a trial, a video, or a folder of pictures")
        video = self._opened()
        self._rate = rate or float(video.get(cv2.CAP_PROP_FPS))
        count = video.get(cv2.CAP_PROP_FRAME_COUNT)
        video.release()
        self._expected = int(count) if 0 < count < 1e9 else None
        self._given: int | None = None
        if not (math.isfinite(self._rate) and _RATES[0] <= self._rate <= _RATES[1]):
            raise InputError(f"{path}: the video has no usable rate ({self._rate:g} Hz); give `--fps`")

    @property
    def name(self) -> str:
        """The file."""
        return str(self._path)

    @property
    def synthetic(self) -> bool:
        """Nobody knows of a bare video."""
        return False

    @property
    def expected(self) -> int | None:
        """How many pictures the file says it has."""
        return self._expected

    @property
    def rate(self) -> float | None:
        """Pictures per second, Hz."""
        return self._rate

    def frames(self) -> Iterator[Frame]:
        """Give the pictures up to the last that can be read, number / rate as time.

        Raises
        ------
        InputError
            There is none.
        """
        video, number = self._opened(), 0
        try:
            while True:
                there, picture = video.read()
                if not there or picture is None:
                    break
                yield Frame(number, number / self._rate, to_grey(np.asarray(picture, dtype=np.uint8)))
                number += 1
        finally:
            video.release()
        self._given = number
        if number == 0:
            raise InputError(f"{self._path}: the video has no picture that can be read")

    def notes(self) -> tuple[str, ...]:
        """Say if the video ended early."""
        if self._given is None or self._expected is None or self._given >= self._expected:
            return ()
        return (f"the video ends after {self._given} of the {self._expected} pictures it should have",)

    def _opened(self) -> cv2.VideoCapture:
        try:
            video = cv2.VideoCapture(str(self._path), cv2.CAP_FFMPEG)
        except cv2.error as error:
            raise InputError(f"{self._path}: no video that can be read ({error.err})") from error
        if not video.isOpened():
            raise InputError(
                f"{self._path}: no video that can be read (cut, empty or of another kind); "
                "allowed: what OpenCV's FFmpeg reads, such as .avi, .mkv, .mp4"
            )
        if int(video.get(cv2.CAP_PROP_CODEC_PIXEL_FORMAT)) == _GREY:
            video.set(cv2.CAP_PROP_CONVERT_RGB, 0)
        return video
