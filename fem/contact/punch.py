"""The rigid round punch with a rounded edge, as a surface the tissue cannot enter.

The punch is a cylinder (r <= a, h >= e) swelled by e, with e its edge radius, a its radius less e and h the height over
its face. So the distance from its surface is |(r, h) - nearest point of the cylinder| - e: face, torus and wall in one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import BoolArray, FloatArray


@dataclass(frozen=True)
class Gap:
    """Distances of m points from the punch, in c coordinates, the vertical one last.

    Attributes
    ----------
    distance
        (m,) in m, negative inside.
    normal
        Derivative by the coordinates, (c, m): outwards.
    bend
        Second derivative in 1/m, its upper triangle row by row, (3, m) or (6, m).
    path
        Coordinates (c - 1, m) in m of the nearest point on the punch: the length along its profile from the axis, in
        three dimensions in the direction seen along the axis.
    along
        Derivative of the path by the coordinates, (c - 1, c, m).
    """

    distance: FloatArray
    normal: FloatArray
    bend: FloatArray
    path: FloatArray
    along: FloatArray


@dataclass(frozen=True)
class Punch:
    """What touches the tissue, in (r, h).

    Attributes
    ----------
    radius, edge_radius
        In m; equal for a spherical tip.
    friction
        Coulomb's coefficient, 0 or more.
    adhesion
        Pull in N that the flat face holds before it lets go all at once.
    """

    radius: float
    edge_radius: float
    friction: float = 0.0
    adhesion: float = 0.0

    @property
    def face(self) -> float:
        """Radius in m of the flat face."""
        return self.radius - self.edge_radius

    def gap(self, place: FloatArray) -> Gap | None:
        """Gap of points at radius and height over the face (2, m) in m; None where one is deep inside."""
        r, h = place
        edge = self.edge_radius
        x, y = np.maximum(r - self.face, 0.0), np.minimum(h - edge, 0.0)
        reach = np.hypot(x, y)
        if not reach.min(initial=np.inf) > 0.0:
            return None
        normal = np.stack((x, y)) / reach
        corner = (x > 0.0) & (y < 0.0)
        n, m = normal
        bend = np.where(corner, np.stack((m * m, -n * m, n * n)) / reach, 0.0)
        turn = np.arctan2(x, -y)
        path = np.minimum(r, self.face) + edge * turn + np.maximum(h - edge, 0.0)
        along = np.stack((-m, n)) * np.where(corner, edge / reach, 1.0)
        return Gap(reach - edge, normal, bend, path[None], along[None])

    def under_face(self, place: FloatArray) -> BoolArray:
        """Which points (c, m) lie under the flat face."""
        out: BoolArray = place[0] <= self.face
        return out

    def metric(self, path: FloatArray) -> FloatArray:
        """Lengths on the punch by steps of the path (c - 1, m), symmetric (c - 1, c - 1, m)."""
        return np.ones((1, *path.shape))
