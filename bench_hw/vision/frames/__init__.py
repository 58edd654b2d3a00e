"""The pictures of a trial, a video or a folder, one after the other; never more than one in memory."""

from bench_hw.vision.frames.opening import open_frames
from bench_hw.vision.frames.source import Frame, FrameSource

__all__ = ["Frame", "FrameSource", "open_frames"]
