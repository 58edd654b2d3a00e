"""What one picture tells about each marker."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.markers.model import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Sighting:
    """The markers of one picture, in the order of their numbers.

    Parameters
    ----------
    points : ndarray, shape (m, 2)
        Centroids, undistorted and normalised; NaN where a marker was not seen.
    pixels : ndarray, shape (m, 2)
        The same in the picture as it is; NaN likewise.
    radius : ndarray, shape (m,)
        Of a circle of the same area, pixels; NaN likewise.
    confidence : ndarray, shape (m,)
        0 (not seen) to 1.
    """

    points: FloatArray
    pixels: FloatArray
    radius: FloatArray
    confidence: FloatArray

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Which markers were seen, shape (m,)."""
        return self.confidence > 0.0

    def kept(self, chosen: NDArray[np.bool_]) -> Sighting:
        """Give it with the markers that are not chosen made unseen."""
        hidden = ~chosen
        return Sighting(
            _with_nan(self.points, hidden),
            _with_nan(self.pixels, hidden),
            _with_nan(self.radius, hidden),
            np.where(chosen, self.confidence, 0.0),
        )

    def merged(self, other: Sighting, which: NDArray[np.int64]) -> Sighting:
        """Give it with the markers `which` as another sighting, of just those, has them."""
        arrays = []
        for name in ("points", "pixels", "radius", "confidence"):
            values = getattr(self, name).copy()
            values[which] = getattr(other, name)
            arrays.append(values)
        return Sighting(*arrays)


def unseen(count: int) -> Sighting:
    """Give a picture in which none of `count` markers was seen."""
    nowhere = np.full((count, 2), np.nan)
    return Sighting(nowhere, nowhere.copy(), np.full(count, np.nan), np.zeros(count))


def _with_nan(values: FloatArray, where: NDArray[np.bool_]) -> FloatArray:
    result = values.copy()
    result[where] = np.nan
    return result
