"""Encoded pictures and colour to grey, with nothing taken for a picture that is not a whole one."""

from __future__ import annotations

import cv2
import numpy as np

from bench_hw.vision.frames.model import Picture

_ENDS = {"jpeg": b"\xff\xd9", "png": b"IEND\xaeB`\x82"}


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
