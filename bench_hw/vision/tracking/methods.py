"""The tracking methods by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Protocol

from bench_hw.vision.camera.model import Camera
from bench_hw.vision.markers.model import Grid, Picture
from bench_hw.vision.markers.sighting import Sighting
from bench_hw.vision.tracking.paper_method import PaperTracker
from bench_hw.vision.tracking.subpixel import SubpixelTracker


class Tracker(Protocol):
    """Follows the markers of one grid; it remembers nothing that grows with the number of pictures."""

    def step(self, grey: Picture) -> Sighting:
        """Take the next picture (the first one, too) and say where the markers are in it."""
        ...


class TrackerMaker(Protocol):
    """Makes a tracker from the picture in which the grid was found."""

    def __call__(self, grey: Picture, grid: Grid, camera: Camera) -> Tracker:
        """Make it."""
        ...


METHODS: Mapping[str, TrackerMaker] = MappingProxyType({"subpixel": SubpixelTracker, "paper": PaperTracker})
"""`subpixel`, the default, and `paper`, the article's chain."""
