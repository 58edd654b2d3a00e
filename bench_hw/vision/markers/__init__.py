"""Markers in one picture: found from nothing (`detect_grid`), or measured where they are about (`MarkerEdges`)."""

from bench_hw.vision.markers.detection import GridError, detect_grid
from bench_hw.vision.markers.grid import PAPER_LAYOUT, Blobs, DetectedGrid, Layout, Sighting, parse_layout
from bench_hw.vision.markers.radial import MarkerEdges

__all__ = [
    "PAPER_LAYOUT",
    "Blobs",
    "DetectedGrid",
    "GridError",
    "Layout",
    "MarkerEdges",
    "Sighting",
    "detect_grid",
    "parse_layout",
]
