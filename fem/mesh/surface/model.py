"""A triangulated surface and simple measures of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Surface:
    """A triangulated surface, z upwards.

    Attributes
    ----------
    points
        Positions (P, 3) in m.
    triangles
        Corners (T, 3), counter-clockwise seen from outside.
    remarks
        What was repaired, in words.
    source
        Where it came from, for messages; "" if it was made in code.
    """

    points: FloatArray
    triangles: IntArray
    remarks: tuple[str, ...] = ()
    source: str = ""

    @property
    def label(self) -> str:
        """What messages call it."""
        return f"surface {self.source}".rstrip()

    @property
    def corners(self) -> FloatArray:
        """Corner positions (T, 3, 3) of each triangle in m."""
        out: FloatArray = self.points[self.triangles]
        return out

    @property
    def area_vectors(self) -> FloatArray:
        """Outward normals (T, 3) as long as the triangles' areas, in m2."""
        a, b, c = self.corners.transpose(1, 0, 2)
        out: FloatArray = 0.5 * np.cross(b - a, c - a)
        return out

    @property
    def volume(self) -> float:
        """Enclosed volume in m3, negative if the triangles look inwards."""
        return float(np.einsum("ti,ti->", self.corners.mean(axis=1), self.area_vectors) / 3.0)

    @property
    def size(self) -> FloatArray:
        """Extents (3,) of the bounding box in m."""
        used = self.points[np.unique(self.triangles)]
        out: FloatArray = used.max(axis=0) - used.min(axis=0)
        return out
