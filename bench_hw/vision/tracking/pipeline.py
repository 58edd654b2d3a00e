"""The way of one picture: tracked, placed, written, drawn, counted."""

from __future__ import annotations

from dataclasses import dataclass

from bench_hw.vision.camera.model import Camera
from bench_hw.vision.frames.model import Frame, FrameSource
from bench_hw.vision.markers.model import Grid, Picture
from bench_hw.vision.markers.sighting import Sighting, unseen
from bench_hw.vision.tracking.jump import JumpError
from bench_hw.vision.tracking.methods import Tracker
from bench_hw.vision.tracking.outcome import Tally
from bench_hw.vision.tracking.overlay import OverlayVideo, Still, draw
from bench_hw.vision.tracking.places import Places
from bench_hw.vision.tracking.rows import RowWriter


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
    grid : Grid
        The markers in the picture the tracking began with.
    tracker : Tracker
        What finds them.
    places : Places
        From sightings to places.
    sinks : Sinks
        Where the results go.
    """

    def __init__(
        self, source: FrameSource, camera: Camera, grid: Grid, tracker: Tracker, places: Places, sinks: Sinks
    ) -> None:
        self._source, self._camera, self._grid = source, camera, grid
        self._tracker, self._places, self._sinks = tracker, places, sinks
        self._label = "synthetic" if source.synthetic else ""
        self.tally = Tally(len(grid.centres), grid.strays)

    def pass_over(self, frame: Frame) -> None:
        """Take a picture from before the beginning: nobody is seen in it."""
        self.tally.before += 1
        self._finish(frame, unseen(len(self._grid.centres)))

    def take(self, frame: Frame) -> None:
        """Take a picture; one that cannot be decoded, or has another size, shows nobody.

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
