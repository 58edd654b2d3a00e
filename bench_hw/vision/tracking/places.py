"""From what a picture tells to rows of the table: places in millimetres or pixels, perspective taken off.

How far markers have sunk towards the camera comes from a table `time_s, sunk_mm` for all markers alike, or `time_s,
marker, sunk_mm`. It is interpolated between two instants; before the first, after the last and for markers that are not
in it nothing is known.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np

from bench_hw.errors import InputError
from bench_hw.storage.atomic import replacing
from bench_hw.tables.columns import check_increasing, read_columns, read_source
from bench_hw.tables.output import rounded_cells
from bench_hw.vision.camera.pinhole import Camera, FloatArray, plane_of, to_plane
from bench_hw.vision.markers.grid import Sighting

_TIME, _SUNK, _MARKER = "time_s", "sunk_mm", "marker"


@dataclass(frozen=True, eq=False, slots=True)
class Sinking:
    """Depths of markers over time.

    Parameters
    ----------
    histories : dict of int to tuple of 2 ndarrays
        Time (s) and sinking (m) by marker; under -1 what holds for all.
    """

    histories: dict[int, tuple[FloatArray, FloatArray]]

    def at(self, time: float, count: int) -> FloatArray:
        """Give how far markers 0 to `count` - 1 have sunk at an instant (s), m; NaN where unknown."""
        return np.array([self._one(marker, time) for marker in range(count)])

    def _one(self, marker: int, time: float) -> float:
        history = self.histories.get(marker, self.histories.get(-1))
        if history is None or not history[0][0] <= time <= history[0][-1]:
            return float("nan")
        return float(np.interp(time, *history))


def read_sinking(path: Path | str) -> Sinking:
    """Read a table of sinking.

    Raises
    ------
    TableError
        Not such a table, or time that does not increase for a marker.
    InputError
        A marker that is no whole number from 0.
    """
    path = Path(path)
    columns = read_columns(read_source(path, (_TIME, _SUNK)), (_TIME, _SUNK))
    time, sunk = columns.values[_TIME], columns.values[_SUNK] / 1e3
    marker = columns.values.get(_MARKER, np.full(len(time), -1.0))
    if _MARKER in columns.values and np.any((marker < 0) | (marker != np.floor(marker))):
        raise InputError(f"{path}: column {_MARKER!r}: allowed are whole numbers from 0")
    histories = {}
    for number in np.unique(marker):
        rows = marker == number
        check_increasing(path, _TIME, time[rows], columns.lines[rows])
        histories[int(number)] = (time[rows], sunk[rows])
    if not histories:
        raise InputError(f"{path}: the table has no rows; allowed: at least one")
    return Sinking(histories)


class Places:
    """Turns sightings into places.

    Parameters
    ----------
    camera : Camera
        With a plane, unless `pixels`.
    pixels : bool
        Undistorted pixels instead of millimetres.
    sinking : Sinking, optional
        With it, perspective is corrected, and a marker of unknown depth has no place.
    recentre : bool
        Take the middle of the markers of the first picture as the origin.

    Raises
    ------
    InputError
        Millimetres from a camera without mm_per_px.
    """

    def __init__(self, camera: Camera, *, pixels: bool, sinking: Sinking | None, recentre: bool) -> None:
        if not pixels:
            plane_of(camera)
        self._camera, self._pixels, self._sinking = camera, pixels, sinking
        self._recentre = recentre
        self._origin: FloatArray | None = None

    @property
    def unit(self) -> str:
        """`mm` or `px`."""
        return "px" if self._pixels else "mm"

    def of(self, sighting: Sighting, time: float) -> FloatArray:
        """Give the places (m, 2) in the table's unit at an instant (s); NaN where there is none."""
        places = self._measured(sighting, time)
        if not self._recentre:
            return places
        if self._origin is None and np.isfinite(places).all():
            self._origin = places.mean(axis=0)
        return places - (np.nan if self._origin is None else self._origin)

    def _measured(self, sighting: Sighting, time: float) -> FloatArray:
        if self._pixels:
            return self._camera.to_pixels(sighting.points)
        sunk = 0.0 if self._sinking is None else self._sinking.at(time, len(sighting.points))
        return to_plane(self._camera, sighting.points, sunk) * 1e3


class RowWriter:
    """Writes rows into an open table.

    Parameters
    ----------
    stream : TextIO
        Where to; the header is written at once.
    unit : str
        `mm` or `px`.
    """

    def __init__(self, stream: TextIO, unit: str) -> None:
        self._stream = stream
        self.rows = 0
        stream.write(f"time_s,marker,x_{unit},y_{unit},confidence\n")

    def write(self, time: float, places: FloatArray, confidence: FloatArray) -> None:
        """Write a frame.

        Parameters
        ----------
        time : float
            s.
        places : ndarray, shape (m, 2)
            In the table's unit; a marker with NaN in it gets empty cells.
        confidence : ndarray, shape (m,)
            0 to 1.
        """
        stamp = repr(float(time))
        x, y = rounded_cells(places[:, 0]), rounded_cells(places[:, 1])
        cells = enumerate(zip(x, y, confidence.tolist(), strict=True))
        lines = [f"{stamp},{marker},{x},{y},{share:.4f}\n" for marker, (x, y, share) in cells]
        self._stream.write("".join(lines))
        self.rows += len(lines)


@contextmanager
def table_of_tracks(path: Path, unit: str) -> Iterator[RowWriter]:
    """Open a table that appears whole when the block ends well, and not at all otherwise.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as stream:
        yield RowWriter(stream, unit)
