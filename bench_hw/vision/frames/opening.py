"""From a path to the source of its pictures."""

from __future__ import annotations

from pathlib import Path

from bench_hw.errors import InputError
from bench_hw.vision.frames.model import FrameSource
from bench_hw.vision.frames.pictures import PictureFrames, is_pictures
from bench_hw.vision.frames.trial import TrialFrames
from bench_hw.vision.frames.video import VideoFrames

_TRIALS = (".mcap", ".mcap.part")


def open_frames(place: str, rate: float | None = None) -> FrameSource:
    """Open a trial, a video, a folder or a pattern of pictures.

    Parameters
    ----------
    place : str
        `NAME.mcap` (also one that is cut, or `.mcap.part`), a video file, a folder of pictures, or a pattern
        such as `frames/*.png` or `frames/%06d.png`.
    rate : float, optional
        Pictures per second, Hz; for videos and pictures only.

    Raises
    ------
    InputError
        There is nothing that can be read, or a rate is given for a trial.
    """
    if place.endswith(_TRIALS):
        if rate is not None:
            raise InputError(f"{place}: `--fps` is for videos and pictures; a trial has the camera's own times")
        return TrialFrames(Path(place))
    return PictureFrames(place, rate) if is_pictures(place) else VideoFrames(Path(place), rate)
