"""What the rays of some markers told in one picture, before anything is judged or undistorted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.markers.edges import Edges
from bench_hw.vision.markers.model import FloatArray, IntArray
from bench_hw.vision.markers.outline import Outlines

Scalar = TypeVar("Scalar", np.float64, np.bool_)


@dataclass(frozen=True, eq=False, slots=True)
class Look:
    """Edges and outlines of some markers.

    Parameters
    ----------
    middles : ndarray, shape (k, 2)
        Where the rays began, pixels.
    edges : Edges
        As found.
    outlines : Outlines
        As judged and filled.
    pixels : ndarray, shape (k, 2)
        Area centroids of the outlines.
    """

    middles: FloatArray
    edges: Edges
    outlines: Outlines
    pixels: FloatArray

    def with_part(self, part: Look, where: IntArray) -> Look:
        """Give it with the markers `where` as in another look, of just those."""
        edges, new = self.edges, part.edges
        return Look(
            _joined(self.middles, part.middles, where),
            Edges(
                _joined(edges.radius, new.radius, where),
                _joined(edges.there, new.there, where),
                _joined(edges.contrast, new.contrast, where),
                _joined(edges.tilt, new.tilt, where),
                _joined(edges.tilt_std, new.tilt_std, where),
                _joined(edges.noise, new.noise, where),
            ),
            Outlines(
                _joined(self.outlines.radius, part.outlines.radius, where),
                _joined(self.outlines.sound, part.outlines.sound, where),
            ),
            _joined(self.pixels, part.pixels, where),
        )


def _joined(whole: NDArray[Scalar], part: NDArray[Scalar], where: IntArray) -> NDArray[Scalar]:
    result = whole.copy()
    result[where] = part
    return result
