"""Whether a surface bounds a body: what is wrong and where, and the repairs that are safe."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.errors import FemError
from fem.mesh.surface.surface_file import Surface

LEAST_SIZE, LARGEST_SIZE = 1e-3, 3.0
LARGEST_HOLE = 0.05  # of the largest side of the body
AT_ONCE = 200_000


def check_surface(surface: Surface) -> Surface:
    """Check a surface and repair what is safe to repair.

    Returns
    -------
    Surface
        Closed, free of self-intersections, looking outwards; repairs are in its `remarks`.

    Raises
    ------
    FemError
        If it is empty, not finite, of an unlikely size, open, branching, twisted or crosses itself.
    """
    _require_points(surface)
    surface = _close(_without_flat(surface))
    _require_manifold(surface)
    surface = _outwards(surface)
    pair = crossing_triangles(surface)
    if pair is not None:
        raise FemError(f"{surface.label}: crosses itself near {_place(pair)}; repair it in a mesh editor")
    return surface


def _require_points(surface: Surface) -> None:
    if len(surface.triangles) < 4:
        raise FemError(f"{surface.label}: has {len(surface.triangles)} triangles; a closed body needs at least 4")
    if not np.isfinite(surface.points).all():
        bad = int(np.flatnonzero(~np.isfinite(surface.points).all(axis=1))[0])
        raise FemError(f"{surface.label}: point {bad} has a coordinate that is not finite")
    size = surface.size
    if not LEAST_SIZE <= size.max() <= LARGEST_SIZE:
        raise FemError(
            f"{surface.label}: is {size[0]:.3g} x {size[1]:.3g} x {size[2]:.3g} m large; the largest side must be from "
            f"{LEAST_SIZE:g} to {LARGEST_SIZE:g} m: is the unit right?"
        )


def _without_flat(surface: Surface) -> Surface:
    """Without triangles that have no area."""
    area = np.linalg.norm(surface.area_vectors, axis=1)
    flat = area <= 1e-12 * float(surface.size.max()) ** 2
    if not flat.any():
        return surface
    remark = f"{int(flat.sum())} triangles without area were left out"
    return replace(surface, triangles=surface.triangles[~flat], remarks=(*surface.remarks, remark))


def _edges(surface: Surface) -> tuple[IntArray, IntArray]:
    """Directed edges (3 T, 2), and how many triangles meet at each one, (3 T,)."""
    directed = surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, inverse, count = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True)
    return directed, count[inverse.ravel()]


def _close(surface: Surface) -> Surface:
    """With small holes filled.

    A hole is filled by triangles to its middle if it is a simple loop no longer than a twentieth of the body.
    """
    directed, count = _edges(surface)
    follow = {int(b): int(a) for a, b in directed[count == 1]}
    points, triangles, remarks = surface.points, [surface.triangles], list(surface.remarks)
    while follow:
        start, node = next(iter(follow.items()))
        loop = [start]
        del follow[start]
        while node in follow:
            loop.append(node)
            node = follow.pop(node)
        place = points[loop].mean(axis=0)
        width = float(np.ptp(points[loop], axis=0).max())
        if node != start or width > LARGEST_HOLE * float(surface.size.max()):
            raise FemError(
                f"{surface.label}: is open near {_place(place)}: an edge of {len(loop)} segments, {width:.3g} m wide; "
                f"holes up to {LARGEST_HOLE * float(surface.size.max()):.3g} m are filled"
            )
        following = np.roll(loop, -1)
        triangles.append(np.stack((loop, following, np.full(len(loop), len(points))), axis=1))
        points = np.concatenate((points, place[None]))
        remarks.append(f"a hole of {len(loop)} edges near {_place(place)} was filled")
    return replace(surface, points=points, triangles=np.concatenate(triangles), remarks=tuple(remarks))


def _require_manifold(surface: Surface) -> None:
    directed, count = _edges(surface)
    if (count != 2).any():
        edge = directed[np.flatnonzero(count != 2)[0]]
        place, meeting = surface.points[edge].mean(axis=0), int(count[count != 2][0])
        raise FemError(f"{surface.label}: {meeting} triangles meet at one edge near {_place(place)}; two must")


def _outwards(surface: Surface) -> Surface:
    directed, _ = _edges(surface)
    _, first, count = np.unique(directed, axis=0, return_index=True, return_counts=True)
    if (count > 1).any():
        place = surface.points[directed[first[count > 1][0]]].mean(axis=0)
        raise FemError(
            f"{surface.label}: neighbouring triangles near {_place(place)} look to opposite sides; orient them alike"
        )
    if surface.volume < 0.0:
        remarks = (*surface.remarks, "the surface looked inwards and was turned")
        return replace(surface, triangles=surface.triangles[:, ::-1], remarks=remarks)
    return surface


def _place(point: FloatArray) -> str:
    return "({:.4g}, {:.4g}, {:.4g}) m".format(*point)


def crossing_triangles(surface: Surface) -> FloatArray | None:
    """A place (3,) in m where an edge of one triangle goes through another, or None.

    Only triangles without a common corner are looked at: neighbours meet at their edge.
    """
    from scipy.spatial import cKDTree  # loaded here: it doubles the start of runs that have no surface

    corners = surface.corners
    centre = corners.mean(axis=1)
    reach = np.linalg.norm(corners - centre[:, None], axis=2).max(axis=1)
    order = np.argsort(reach)
    tree = cKDTree(centre)
    for part in np.array_split(order, max(1, len(order) // 2000)):
        near = tree.query_ball_point(centre[part], reach[part] + reach.max())
        first = np.repeat(part, [len(found) for found in near])
        second = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
        gap = np.linalg.norm(centre[first] - centre[second], axis=1)
        close = (first != second) & (gap <= reach[first] + reach[second])
        first, second = first[close], second[close]
        shared = (surface.triangles[first][:, :, None] == surface.triangles[second][:, None, :]).any(axis=(1, 2))
        first, second = first[~shared], second[~shared]
        for start in range(0, len(first), AT_ONCE):
            a, b = corners[first[start : start + AT_ONCE]], corners[second[start : start + AT_ONCE]]
            for k in range(3):
                hit = _through(a[:, k], a[:, (k + 1) % 3], b)
                if hit.any():
                    return np.asarray(b[hit][0].mean(axis=0))
    return None


def _through(start: FloatArray, end: FloatArray, triangle: FloatArray) -> BoolArray:
    """Whether segments (m, 3) pass through the inside of triangles (m, 3, 3), by signed volumes."""
    a, b, c = triangle.transpose(1, 0, 2)
    below, above = _volume(start, a, b, c), _volume(end, a, b, c)
    sides = [_volume(start, end, p, q) for p, q in ((a, b), (b, c), (c, a))]
    same = np.all([s > 0.0 for s in sides], axis=0) | np.all([s < 0.0 for s in sides], axis=0)
    out: BoolArray = (below * above < 0.0) & same
    return out


def _volume(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    out: FloatArray = np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a))
    return out
