"""Markers from picture to picture: methods, linking, tables, overlays; `track` does it all."""

from bench_hw.vision.tracking.jump import JumpError
from bench_hw.vision.tracking.methods import METHODS, Tracker
from bench_hw.vision.tracking.outcome import TrackOutcome
from bench_hw.vision.tracking.run import TrackOrder, track

__all__ = ["METHODS", "JumpError", "TrackOrder", "TrackOutcome", "Tracker", "track"]
