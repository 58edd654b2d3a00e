"""The way of one picture (tracked, placed, written, drawn, counted) and what the whole way gave."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench_hw.vision.camera.pinhole import Camera
from bench_hw.vision.frames.source import Frame, FrameSource
from bench_hw.vision.markers.grid import DetectedGrid, FloatArray, IntArray, Picture, Sighting, unseen
from bench_hw.vision.tracking.linking import JumpError
from bench_hw.vision.tracking.methods import Tracker
from bench_hw.vision.tracking.overlay import OverlayVideo, Still, draw
from bench_hw.vision.tracking.places import Places, RowWriter

SCHEMA = 1
_LISTED = 6
KNOCK = 0.1
"""Share of the spacing by which all markers must move together, from a picture to the next, to be told of."""
_UNUSUAL = 10.0
"""Times the usual common step that it must be."""
_FEWEST = 6
"""Markers seen in both pictures."""


class Tally:
    """Counts pictures and markers.

    Parameters
    ----------
    markers : int
        How many there are.
    strays : int
        Spots of a marker's size beside the grid.
    """

    def __init__(self, markers: int, strays: int) -> None:
        self.frames = self.undecoded = self.other_size = self.before = self.repeated = 0
        self.strays = strays
        self.missing: IntArray = np.zeros(markers, dtype=np.int64)
        self.unplaced = 0
        self.confidence = np.zeros(markers)
        self.squares = np.zeros(markers)

    def count(self, sighting: Sighting, places: FloatArray) -> None:
        """Count a picture."""
        self.frames += 1
        self.missing += ~sighting.seen
        self.confidence += sighting.confidence
        self.squares += np.nan_to_num(sighting.error**2) if sighting.error.size else np.nan
        self.unplaced += int((sighting.seen & ~np.isfinite(places).all(axis=1)).sum())

    @property
    def error(self) -> FloatArray:
        """Stated standard deviation of each marker's centroid along an axis, root mean square, pixels, (m,)."""
        seen = self.frames - self.missing
        return np.asarray(np.sqrt(self.squares / np.where(seen > 0, seen, np.nan)))

    def warnings(self) -> list[str]:
        """Give a sentence for each thing that was not as it should be."""
        gone = "all markers are missing in them"
        sentences = [
            (self.before, f"pictures before the first one with the whole grid: {gone}"),
            (self.undecoded, f"pictures cannot be decoded: {gone}"),
            (self.other_size, f"pictures have another size: {gone}"),
            (self.repeated, "pictures are the one before to the last grey level: no marker can have moved in them"),
            (self.strays, "spots of a marker's size beside the grid are left out"),
            (self.unplaced, "places are left empty: how far the marker had sunk is not known"),
            (int(self.missing.sum()), self._missing_sentence()),
        ]
        return [f"{count} {sentence}" for count, sentence in sentences if count]

    def _missing_sentence(self) -> str:
        worst = np.argsort(-self.missing, kind="stable")[:_LISTED]
        listed = ", ".join(f"marker {k} in {self.missing[k]}" for k in worst if self.missing[k])
        return f"of {self.frames * len(self.missing)} sightings are missing: {listed} pictures"


class Knocks:
    """Finds pictures before which all markers moved together, as no press moves them.

    Parameters
    ----------
    spacing : float
        Distance of neighbours, pixels.
    """

    def __init__(self, spacing: float) -> None:
        self._spacing = spacing
        self._last: FloatArray | None = None
        self._ways: list[tuple[float, int, float]] = []

    def add(self, frame: Frame, pixels: FloatArray) -> None:
        """Take down how far the markers, (m, 2) pixels with NaN for those unseen, moved together."""
        if self._last is not None:
            ways = pixels - self._last
            seen = np.isfinite(ways).all(axis=1)
            if seen.sum() >= _FEWEST:
                way = float(np.hypot(*np.median(ways[seen], axis=0)))
                self._ways.append((way, frame.number, frame.time))
        self._last = pixels

    def warnings(self) -> list[str]:
        """Name the picture of the largest common step, where that is large and far beyond the usual one."""
        if not self._ways:
            return []
        way, number, time = max(self._ways)
        usual = float(np.median([each[0] for each in self._ways]))
        if way < KNOCK * self._spacing or way < _UNUSUAL * usual:
            return []
        return [
            f"picture {number} at {time:.3f} s: all markers moved together by {way:.1f} px from the picture before "
            f"(usual: {usual:.2g} px); was the camera knocked, or the specimen shifted? Places before and after do not "
            "compare"
        ]


@dataclass(frozen=True, eq=False, slots=True)
class TrackOutcome:
    """What `track` wrote.

    Parameters
    ----------
    out : pathlib.Path
        The table.
    method : str
        How the markers were found.
    grid : DetectedGrid
        The markers at the beginning.
    tally : Tally
        Counts.
    synthetic : bool
        Whether the source says it is synthetic.
    warnings : tuple of str
        A sentence each.
    """

    out: Path
    method: str
    grid: DetectedGrid
    tally: Tally
    synthetic: bool
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Give it as it stands in the JSON of `track`."""
        tally, grid = self.tally, self.grid
        return {
            "schema": SCHEMA,
            "out": str(self.out),
            "method": self.method,
            "synthetic": self.synthetic,
            "frames": tally.frames,
            "markers": grid.layout.count,
            "rows": grid.layout.rows,
            "columns": grid.layout.columns,
            "radius_px": grid.radius,
            "spacing_px": grid.spacing,
            "missing": tally.missing.tolist(),
            "mean_confidence": (tally.confidence / max(tally.frames, 1)).tolist(),
            "error_px": tally.error.tolist(),
            "warnings": list(self.warnings),
        }


@dataclass(frozen=True, eq=False, slots=True)
class Sinks:
    """Where results go: the table, and what is drawn if anybody wants it."""

    table: RowWriter
    video: OverlayVideo | None = None
    still: Still | None = None


class Pipeline:
    """Takes pictures one after the other.

    Parameters
    ----------
    source : FrameSource
        Where they come from.
    camera : Camera
        Whose size they must have.
    grid : DetectedGrid
        The markers in the picture the tracking began with.
    tracker : Tracker
        What finds them.
    places : Places
        From sightings to places.
    sinks : Sinks
        Where the results go.
    """

    def __init__(
        self, source: FrameSource, camera: Camera, grid: DetectedGrid, tracker: Tracker, places: Places, sinks: Sinks
    ) -> None:
        self._source, self._camera, self._grid = source, camera, grid
        self._tracker, self._places, self._sinks = tracker, places, sinks
        self._label = "synthetic" if source.synthetic else ""
        self.tally = Tally(len(grid.centres), grid.strays)
        self.knocks = Knocks(grid.spacing)
        self._grey: Picture | None = None

    def pass_over(self, frame: Frame) -> None:
        """Take a picture from before the beginning: no marker is seen in it."""
        self.tally.before += 1
        self._finish(frame, unseen(len(self._grid.centres)))

    def take(self, frame: Frame) -> None:
        """Take a picture; one that cannot be decoded, or has another size, shows no marker.

        Raises
        ------
        JumpError
            Names the picture.
        """
        if frame.grey is None or frame.grey.shape != self._camera.size[::-1]:
            self.tally.undecoded += frame.grey is None
            self.tally.other_size += frame.grey is not None
            self._finish(frame, unseen(len(self._grid.centres)))
            return
        try:
            sighting = self._tracker.step(frame.grey)
        except JumpError as error:
            raise JumpError(f"{self._source.name}: picture {frame.number} at {frame.time:.3f} s: {error}") from error
        self.tally.repeated += self._grey is not None and np.array_equal(frame.grey, self._grey)
        self._grey = frame.grey
        self.knocks.add(frame, sighting.pixels)
        self._finish(frame, sighting)

    def _finish(self, frame: Frame, sighting: Sighting) -> None:
        places = self._places.of(sighting, frame.time)
        self._sinks.table.write(frame.time, places, sighting.confidence)
        self.tally.count(sighting, places)
        if frame.grey is not None and frame.grey.shape == self._camera.size[::-1]:
            self._draw(frame.grey, sighting, f"{frame.time:.3f} s {self._label}")

    def _draw(self, grey: Picture, sighting: Sighting, label: str) -> None:
        if self._sinks.video is not None:
            self._sinks.video.write(draw(grey, sighting, self._grid.centres, label))
        if self._sinks.still is not None:
            self._sinks.still.offer(grey, sighting, label)
