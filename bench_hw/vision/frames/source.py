"""One picture with its time, what gives pictures, and encoded pictures and colour turned to grey levels."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
_ENDS = {"jpeg": b"\xff\xd9", "png": b"IEND\xaeB`\x82"}


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """A picture of a source.

    Parameters
    ----------
    number : int
        Place in the source, from 0.
    time : float
        s: the camera's own stamp on the trial's clock, or number / rate for a bare video.
    grey : ndarray of uint8, shape (height, width), or None
        None where the picture is there but cannot be decoded.
    """

    number: int
    time: float
    grey: Picture | None


class FrameSource(Protocol):
    """Gives pictures in their order, from the first one each time it is asked."""

    @property
    def name(self) -> str:
        """What is read, for messages."""
        ...

    @property
    def synthetic(self) -> bool:
        """Whether the source says of itself that it is synthetic."""
        ...

    @property
    def expected(self) -> int | None:
        """How many pictures there should be, None if unknown."""
        ...

    @property
    def rate(self) -> float | None:
        """Pictures per second where the source has a fixed rate, Hz."""
        ...

    def frames(self) -> Iterator[Frame]:
        """Give the pictures; their times increase strictly."""
        ...

    def notes(self) -> tuple[str, ...]:
        """Say what was wrong with the source, a sentence each; complete once all pictures are given."""
        ...


def decode_grey(data: bytes, kind: str) -> Picture | None:
    """Decode a picture.

    Parameters
    ----------
    data : bytes
        The encoded picture.
    kind : str
        `jpeg`, `png` or `webp`.

    Returns
    -------
    ndarray of uint8, shape (height, width), or None
        None for what is no whole picture: a JPEG without its end would be decoded with its lower part grey.
    """
    if not data.rstrip(b"\0\r\n").endswith(_ENDS.get(kind, b"")):
        return None
    try:
        picture = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_GRAYSCALE)
    except cv2.error:
        return None
    return None if picture is None else np.asarray(picture, dtype=np.uint8)


def to_grey(picture: Picture) -> Picture:
    """Give a picture (height, width) from one with 1, 3 (blue, green, red) or 4 channels, or none."""
    if picture.ndim == 2:
        return picture
    if picture.shape[2] == 1:
        return np.ascontiguousarray(picture[:, :, 0])
    code = cv2.COLOR_BGRA2GRAY if picture.shape[2] == 4 else cv2.COLOR_BGR2GRAY
    return np.asarray(cv2.cvtColor(picture, code), dtype=np.uint8)
