"""Markers from picture to picture: methods, linking, tables, overlays; `track` does it all."""

from bench_hw.vision.tracking.film import TrackOrder, track
from bench_hw.vision.tracking.linking import JumpError
from bench_hw.vision.tracking.methods import METHODS, Tracker
from bench_hw.vision.tracking.pipeline import TrackOutcome

__all__ = ["METHODS", "JumpError", "TrackOrder", "TrackOutcome", "Tracker", "track"]
