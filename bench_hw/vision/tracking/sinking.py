"""How far markers have sunk towards the camera, where somebody knows: what perspective is corrected with.

A table `time_s, sunk_mm` for all markers alike, or `time_s, marker, sunk_mm`. Between two instants it is interpolated;
before the first, after the last and for markers that are not in it nothing is known.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench_hw.errors import InputError
from bench_hw.tables.columns import check_increasing, read_columns
from bench_hw.tables.source import read_source
from bench_hw.vision.camera.model import FloatArray

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
        """Give how far markers 0 to `count` - 1 have sunk at an instant (s), m; NaN where nobody knows."""
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
