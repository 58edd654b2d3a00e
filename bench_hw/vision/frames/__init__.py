"""The pictures of a trial, a video or a folder, one after the other; never more than one in memory."""

from bench_hw.vision.frames.model import Frame, FrameSource
from bench_hw.vision.frames.opening import open_frames

__all__ = ["Frame", "FrameSource", "open_frames"]
