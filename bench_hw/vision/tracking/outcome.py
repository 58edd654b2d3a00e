"""What a tracking gave: counts, and a sentence for everything that was not as it should be."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench_hw.vision.markers.model import FloatArray, Grid, IntArray
from bench_hw.vision.markers.sighting import Sighting

SCHEMA = 1
_LISTED = 6


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
        self.frames = self.undecoded = self.other_size = self.before = 0
        self.strays = strays
        self.missing: IntArray = np.zeros(markers, dtype=np.int64)
        self.unplaced = 0
        self.confidence = np.zeros(markers)

    def count(self, sighting: Sighting, places: FloatArray) -> None:
        """Count a picture."""
        self.frames += 1
        self.missing += ~sighting.seen
        self.confidence += sighting.confidence
        self.unplaced += int((sighting.seen & ~np.isfinite(places).all(axis=1)).sum())

    def warnings(self) -> list[str]:
        """Give a sentence for each thing that was not as it should be."""
        gone = "all markers are missing in them"
        sentences = [
            (self.before, f"pictures before the first one with the whole grid: {gone}"),
            (self.undecoded, f"pictures cannot be decoded: {gone}"),
            (self.other_size, f"pictures have another size: {gone}"),
            (self.strays, "spots of a marker's size beside the grid are left out"),
            (self.unplaced, "places are left empty: how far the marker had sunk is not known"),
            (int(self.missing.sum()), self._missing_sentence()),
        ]
        return [f"{count} {sentence}" for count, sentence in sentences if count]

    def _missing_sentence(self) -> str:
        worst = np.argsort(-self.missing, kind="stable")[:_LISTED]
        listed = ", ".join(f"marker {k} in {self.missing[k]}" for k in worst if self.missing[k])
        return f"of {self.frames * len(self.missing)} sightings are missing: {listed} pictures"


@dataclass(frozen=True, eq=False, slots=True)
class TrackOutcome:
    """What `track` wrote.

    Parameters
    ----------
    out : pathlib.Path
        The table.
    method : str
        How the markers were found.
    grid : Grid
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
    grid: Grid
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
            "warnings": list(self.warnings),
        }
