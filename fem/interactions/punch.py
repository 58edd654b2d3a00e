"""The rigid round punch with a rounded edge, as a surface the tissue cannot enter.

The punch is a cylinder (r <= a, h >= e) swelled by e, with e its edge radius, a its radius less e and h the height over
its face. So the distance from its surface is |(r, h) - nearest point of the cylinder| - e: face, torus and wall in one.

In three dimensions the punch stands somewhere and may lean.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fem.arrays import BoolArray, FloatArray

NEAR_AXIS = 1e-12  # radius within which a point has no direction from the axis, in radii of the punch
TOUCHING = 1e-14  # depth by which a lowered punch enters, in its radii
MOST_DROPS = 100
PACKED = np.triu_indices(3)


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


@dataclass(frozen=True)
class SolidPunch(Punch):
    """What touches the tissue, in (x, y, z).

    Attributes
    ----------
    foot
        Middle (x, y, z) in m of the face.
    tilt
        Angle in rad of the axis from the vertical in the x-z plane, its upper end towards +x.
    """

    foot: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tilt: float = 0.0

    @property
    def _axes(self) -> FloatArray:
        """Two axes across the punch and its own axis, (3, 3), in rows."""
        s, c = math.sin(self.tilt), math.cos(self.tilt)
        return np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])

    def _own(self, place: FloatArray) -> FloatArray:
        """Points (3, m) in the punch's own axes."""
        out: FloatArray = self._axes @ (place - np.array(self.foot)[:, None])
        return out

    def gap(self, place: FloatArray) -> Gap | None:
        """Gap of points (3, m) in m; None where one is deep inside."""
        x, y, h = self._own(place)
        r = np.hypot(x, y)
        none = NEAR_AXIS * self.radius
        plane = super().gap(np.stack((np.maximum(r, none), h)))
        if plane is None:
            return None
        away = r > none
        r = np.where(away, r, none)
        direction = np.where(away, np.stack((x, y)) / r, [[1.0], [0.0]])
        square = np.stack((-direction[1], direction[0]))
        outward, round_, axis = self._axes[:2].T @ direction, self._axes[:2].T @ square, self._axes[2][:, None]
        normal = plane.normal[0] * outward + plane.normal[1] * axis
        rr, rh, hh = plane.bend
        i, j = PACKED
        bend = rr * outward[i] * outward[j] + rh * (outward[i] * axis[j] + axis[i] * outward[j])
        bend += hh * axis[i] * axis[j] + plane.normal[0] / r * round_[i] * round_[j]
        by_r, by_h = plane.along[0]
        meridian = by_r * outward + by_h * axis
        along = direction[:, None] * meridian + square[:, None] * (plane.path[0] / r * round_)
        return Gap(plane.distance, normal, bend, plane.path * direction, along)

    def under_face(self, place: FloatArray) -> BoolArray:
        """Which points (3, m) lie under the flat face."""
        x, y, _ = self._own(place)
        out: BoolArray = np.hypot(x, y) <= self.face
        return out

    def metric(self, path: FloatArray) -> FloatArray:
        """Lengths on the punch by steps of the path (2, m), symmetric (2, 2, m): less round the axis than from it."""
        length = np.hypot(*path)
        turn = np.clip((length - self.face) / self.edge_radius, 0.0, 0.5 * np.pi)
        ring = np.minimum(length, self.face) + self.edge_radius * np.sin(turn)
        away = length > NEAR_AXIS * self.radius
        share = np.where(away, ring / np.where(away, length, 1.0), 1.0)
        direction = np.where(away, path / np.where(away, length, 1.0), 0.0)
        out: FloatArray = share * np.eye(2)[..., None] + (1.0 - share) * direction[:, None] * direction
        return out

    @property
    def tip(self) -> tuple[float, float, float]:
        """Middle (x, y, z) in m of the cylinder inside the edge, over the face by the edge radius."""
        x, y, z = self.foot
        e = self.edge_radius
        return x + e * math.sin(self.tilt), y, z + e * math.cos(self.tilt)

    def lowered(self, place: FloatArray) -> SolidPunch:
        """The punch moved down until it touches the first of the points (3, m)."""
        punch = self
        for _ in range(MOST_DROPS):
            gap = punch.gap(place)
            if gap is None or gap.distance.min() <= 0.0:
                break
            x, y, z = punch.foot
            punch = replace(punch, foot=(x, y, z - float(gap.distance.min()) - TOUCHING * self.radius))
        return punch


def standing(punch: Punch, position: tuple[float, float], tilt: float) -> SolidPunch:
    """The punch whose lowest point is at z = 0, where its axis meets the plane z = 0 at the position (x, y) in m."""
    height = punch.edge_radius * (1.0 - math.cos(tilt)) + punch.face * abs(math.sin(tilt))
    foot = (position[0] + height * math.tan(tilt), position[1], height)
    return SolidPunch(punch.radius, punch.edge_radius, punch.friction, punch.adhesion, foot, tilt)
