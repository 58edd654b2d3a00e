"""Markers that were away, and whether what comes back is really they.

While a marker is hidden the sheet may move on by as much as the spacing; then a neighbour stands where it was last
seen. So a marker that comes back must have moved, since it went, about as its neighbours have.
"""

from __future__ import annotations

import numpy as np

from bench_hw.vision.markers.model import FloatArray, IntArray
from bench_hw.vision.markers.sighting import Sighting

_WITNESSES = 4


class Absences:
    """Remembers, for each marker that is away, where all were when it went.

    Parameters
    ----------
    limit : float
        How far a marker's way may be from its neighbours' one, pixels.
    """

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._when_it_went: dict[int, FloatArray] = {}

    def checked(self, sighting: Sighting) -> Sighting:
        """Give a sighting without the markers that came back to a place that is not theirs."""
        seen = sighting.seen
        back = [marker for marker in self._when_it_went if seen[marker]]
        if not back:
            return sighting
        witnesses = np.array([m for m in np.flatnonzero(seen).tolist() if m not in self._when_it_went], dtype=np.int64)
        wrong = [marker for marker in back if not self._agrees(marker, sighting.pixels, witnesses)]
        chosen = np.ones(len(seen), dtype=bool)
        chosen[wrong] = False
        return sighting.kept(chosen & seen) if wrong else sighting

    def note(self, sighting: Sighting, last: FloatArray) -> None:
        """Take down who went and who is back; `last` (m, 2) is where each was seen last, pixels."""
        for marker, seen in enumerate(sighting.seen.tolist()):
            if seen:
                self._when_it_went.pop(marker, None)
            elif marker not in self._when_it_went:
                self._when_it_went[marker] = last.copy()

    def _agrees(self, marker: int, places: FloatArray, witnesses: IntArray) -> bool:
        """Whether its way is that of the nearest markers that were never away; true if there are none."""
        if not len(witnesses):
            return True
        before = self._when_it_went[marker]
        way = places - before
        near = witnesses[np.argsort(np.hypot(*(before[witnesses] - before[marker]).T))[:_WITNESSES]]
        return bool(np.hypot(*(way[marker] - np.median(way[near], axis=0))) < self._limit)
