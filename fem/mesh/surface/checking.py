"""Whether a surface bounds a body: what is wrong and where, and the repairs that are safe."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.errors import FemError
from fem.mesh.surface.filling import signed_distance
from fem.mesh.surface.surface_file import Surface

LEAST_SIZE, LARGEST_SIZE = 1e-3, 3.0
LARGEST_HOLE = 0.05  # of the largest side of the body
AT_ONCE = 200_000
ROUNDING = 1e-6  # of the largest coordinate: how far apart what touches may be in a file of single precision
MOST_TOLD = 5  # shells
OVERLAP = 10.0  # in the same, of two triangles in one plane


def check_surface(surface: Surface) -> Surface:
    """Check a surface and repair what is safe to repair.

    Returns
    -------
    Surface
        One closed shell, with hollows or without, free of self-intersections, looking outwards; repairs are in its
        `remarks`.

    Raises
    ------
    FemError
        If it is empty, not finite, of an unlikely size, open, branching, twisted, crosses or touches itself,
        or has several shells.
    """
    _require_points(surface)
    surface = _close(_without_flat(surface))
    _require_manifold(surface)
    surface = _outwards(surface)
    pair = touching_triangles(surface)
    if pair is not None:
        raise FemError(
            f"{surface.label}: touches itself or is folded flat near {_place(pair)}; allowed are faces further apart "
            f"than {_rounding(surface):.2g} m: part them, or join the body there, in a mesh editor"
        )
    pair = crossing_triangles(surface)
    if pair is not None:
        raise FemError(f"{surface.label}: crosses itself near {_place(pair)}; repair it in a mesh editor")
    _require_one_shell(surface)
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


def _require_one_shell(surface: Surface) -> None:
    """One shell, and within it any that look into hollows."""
    edges = np.sort(surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owner = np.lexsort(edges.T) // 3  # two triangles at each edge, one after the other
    links = sp.coo_array((np.ones(len(owner) // 2), (owner[::2], owner[1::2])), shape=(len(edges) // 3,) * 2)
    count, part = sp.csgraph.connected_components(links, directed=False)
    if count == 1:
        return
    shells = [replace(surface, triangles=surface.triangles[part == n]) for n in range(count)]
    outer = max(shells, key=lambda shell: shell.volume)
    if all(shell is outer or (shell.volume < 0.0 and _lies_in(shell, outer)) for shell in shells):
        return
    shells.sort(key=lambda shell: -abs(shell.volume))
    told = ", ".join(
        f"{1e6 * s.volume:.4g} cm3 round {_place(s.corners.mean(axis=(0, 1)))}" for s in shells[:MOST_TOLD]
    )
    more = f" and {count - MOST_TOLD} more" if count > MOST_TOLD else ""
    raise FemError(
        f"{surface.label}: has {count} shells: {told}{more}; allowed is one closed shell, and within it shells that "
        "look into hollows (negative volume): keep one body, or join them, in a mesh editor"
    )


def _lies_in(shell: Surface, outer: Surface) -> bool:
    return bool((signed_distance(outer, shell.points[np.unique(shell.triangles)]) > 0.0).all())


def crossing_triangles(surface: Surface) -> FloatArray | None:
    """A place (3,) in m where an edge of one triangle goes through another, or None.

    Only triangles without a common corner are looked at: neighbours meet at their edge. An end of the edge that is no
    further from the triangle's plane than a file's rounding goes through nothing: flat walls are of many triangles.
    """
    corners, least = surface.corners, _rounding(surface)
    for first, second in _near(surface):
        shared = (surface.triangles[first][:, :, None] == surface.triangles[second][:, None, :]).any(axis=(1, 2))
        a, b = corners[first[~shared]], corners[second[~shared]]
        for k in range(3):
            hit = _through(a[:, k], a[:, (k + 1) % 3], b, least)
            if hit.any():
                return np.asarray(b[hit][0].mean(axis=0))
    return None


def touching_triangles(surface: Surface) -> FloatArray | None:
    """A place (3,) in m where two triangles lie upon each other in one plane, or None."""
    corners, least = surface.corners, _rounding(surface)
    for first, second in _near(surface):
        a, b = corners[first], corners[second]
        normal = np.cross(a[:, 1] - a[:, 0], a[:, 2] - a[:, 0])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        flat = (np.abs(np.einsum("nki,ni->nk", b - a[:, :1], normal)) <= least).all(axis=1)
        a, b, normal = a[flat], b[flat], normal[flat]
        upon = np.ones(len(a), dtype=np.bool_)
        for corner in (a, b):
            for k in range(3):  # apart if any edge parts them
                axis = np.cross(normal, corner[:, (k + 1) % 3] - corner[:, k])
                axis /= np.linalg.norm(axis, axis=1, keepdims=True)
                p, q = (np.einsum("nki,ni->nk", each - a[:, :1], axis) for each in (a, b))
                common = np.minimum(p.max(axis=1), q.max(axis=1)) - np.maximum(p.min(axis=1), q.min(axis=1))
                upon &= common > OVERLAP * least
        if upon.any():
            return np.asarray(b[upon][0].mean(axis=0))
    return None


def _rounding(surface: Surface) -> float:
    """How far apart in m what touches may be."""
    return ROUNDING * float(np.abs(surface.points).max())


def _near(surface: Surface) -> Iterator[tuple[IntArray, IntArray]]:
    """Numbers (n,) of triangles whose surrounding spheres meet, both ways round."""
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
        for start in range(0, len(first), AT_ONCE):
            yield first[start : start + AT_ONCE], second[start : start + AT_ONCE]


def _through(start: FloatArray, end: FloatArray, triangle: FloatArray, least: float) -> BoolArray:
    """Whether segments (m, 3) pass through the inside of triangles (m, 3, 3), by signed volumes.

    Their ends must be more than `least` m off the plane.
    """
    a, b, c = triangle.transpose(1, 0, 2)
    below, above = _volume(start, a, b, c), _volume(end, a, b, c)
    sides = [_volume(start, end, p, q) for p, q in ((a, b), (b, c), (c, a))]
    same = np.all([s > 0.0 for s in sides], axis=0) | np.all([s < 0.0 for s in sides], axis=0)
    off = np.minimum(np.abs(below), np.abs(above)) > least * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    out: BoolArray = (below * above < 0.0) & same & off
    return out


def _volume(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    out: FloatArray = np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a))
    return out
