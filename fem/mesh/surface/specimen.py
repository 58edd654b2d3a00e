"""From a surface and layers to the mesh of a specimen under a tool."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.errors import FemError
from fem.mesh.surface.checking import check_surface
from fem.mesh.surface.filling import Refinement, kept_filling
from fem.mesh.surface.own_process import has_seed
from fem.mesh.surface.surface_file import Surface
from fem.mesh.surface.surface_mesh import POOR, MeshQuality, SurfaceMesh, barycentric, measure_quality

EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))  # mid-side nodes 4 to 9
FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))  # looking outwards
BASE_HEIGHT = 0.15  # of the body: a face of its underside that lies whole in it rests on the base,
BASE_ANGLE = 53.0  # degrees; if its outward normal points within them of straight down
LOOKING_UP = 0.2  # least vertical part of the normal of a face that the tool touches
WORST = 1e-3
UNLIKE = "the mesher takes no seed on this system: each run has another mesh, and differs by what the mesh is worth"
MOST_VOLUME_ERROR = 0.1
LARGEST_BODY = 100.0  # in tool radii: a larger one is remarked upon
FINER_AT_EDGE = 8.0  # elements at the tool's edge than under its middle
EDGE_PLACES = 64  # at which the tool's edge is sought on the surface
PARTS = 16  # of each side of a face, where the tool's circle is integrated


def build_surface_mesh(
    surface: Surface,
    thickness: tuple[float, ...],
    tool: tuple[float, float, float],
    density: float,
    keep: Path | None = None,
) -> SurfaceMesh:
    """Mesh of a specimen.

    Parameters
    ----------
    surface
        Its surface as read; it is checked here.
    thickness
        Thickness (L,) in m of the layers from the surface inwards; the last one fills the rest.
    tool, density
        x, y and radius in m of the tool; 1 for the default mesh, larger is finer.
    keep
        File in which the mesher's tetrahedra are kept, and taken from if it holds those of the same specimen.

    Raises
    ------
    FemError
        If the surface is bad, the tool is not above it, or the mesh is unusable.
    """
    surface = check_surface(surface)
    _require_depth(surface, thickness[:-1])
    x, y, radius = tool
    place = touch_point(surface, x, y)
    fine = radius / (2.0 * density)
    coarse = max(fine, float(surface.size.max()) / (10.0 * density))
    edge = _tool_edge(surface, place, radius)
    refinement = Refinement(place, radius, edge, fine / FINER_AT_EDGE, fine, coarse, 0.5 / density)
    points, tetrahedra, layer = kept_filling(surface, np.cumsum(thickness[:-1]), refinement, keep)
    points = _with_vertex(points, tetrahedra, place)
    quality = measure_quality(points, tetrahedra, layer, surface.volume)
    _require_quality(surface, quality)
    remarks = (*surface.remarks, *_size_remark(surface, radius))
    if quality.least < POOR / 2:
        remarks = (*remarks, f"mesh quality: {quality}")
    if not has_seed():
        remarks = (*remarks, UNLIKE)
    mesh = _pressed_mesh(*quadratic(points, tetrahedra), layer, place, radius, quality, remarks)
    _require_base(surface, mesh)
    return mesh


def _pressed_mesh(
    nodes: FloatArray,
    elements: IntArray,
    layer: IntArray,
    place: FloatArray,
    radius: float,
    quality: MeshQuality,
    remarks: tuple[str, ...],
) -> SurfaceMesh:
    """Mesh of 10-node elements (10, E) with the load of a tool that touches it at a place (3,)."""
    x, y, _ = place.tolist()
    faces = _layer_faces(elements, layer)
    up = _upward(nodes, faces[0])
    touched = _touched(nodes, faces[0], up, place, radius)
    if not touched.any():
        raise FemError(f"tool.position = ({x:g}, {y:g}) m: no face of the mesh lies under the tool")
    load = _disc_load(nodes, faces[0], up, place, radius)
    under = faces[0][:, _resting(nodes, faces[0], up)]
    nobody = np.zeros(len(nodes), dtype=np.bool_)
    return SurfaceMesh(
        nodes,
        elements,
        "tet10",
        layer,
        axis_point=(x, y),
        images=1,
        mirror_x=nobody,
        mirror_y=nobody,
        top=_marked(len(nodes), faces[0][:, touched]),
        base=_marked(len(nodes), under),
        border=nobody,
        interfaces=(np.array([int(np.linalg.norm(nodes - place, axis=1).argmin())]),),
        top_elements=np.zeros(0, dtype=np.int64),
        layer_faces=faces,
        tool_load=-load / load.sum(),
        quality=quality,
        remarks=remarks,
    )


def _require_depth(surface: Surface, above: tuple[float, ...]) -> None:
    """No place lies deeper than half the smallest side."""
    deepest = 0.5 * float(surface.size.min())
    if sum(above) >= deepest:
        raise FemError(
            f"{surface.label}: the layers above the last one are {sum(above):.3g} m thick together, but no place in "
            f"the body is deeper than {deepest:.3g} m: is the unit right?"
        )


def _require_quality(surface: Surface, quality: MeshQuality) -> None:
    if abs(quality.volume_error) > MOST_VOLUME_ERROR:
        raise FemError(f"{surface.label}: the mesh does not fill it, is it more than one body? {quality}")
    if quality.least <= WORST:
        raise FemError(f"{surface.label}: the mesh is unusable, a tetrahedron is flat; {quality}")


def _require_base(surface: Surface, mesh: SurfaceMesh) -> None:
    if not mesh.base.any():
        low, height = float(mesh.nodes[:, 2].min()), float(np.ptp(mesh.nodes[:, 2]))
        raise FemError(
            f"{surface.label}: no face of the mesh rests on the base; at least one must lie whole in the lowest "
            f"{100 * BASE_HEIGHT:g} % of the body (z from {low:.4g} to {low + BASE_HEIGHT * height:.4g} m), its "
            f"outward normal within {BASE_ANGLE:g} degrees of straight down (-z): turn the body (z upwards), give it "
            "an underside, or make the mesh finer"
        )


def _size_remark(surface: Surface, radius: float) -> tuple[str, ...]:
    width = float(surface.size.max())
    if width <= LARGEST_BODY * radius:
        return ()
    return (f"{surface.label}: is {width:.3g} m wide, {width / radius:.0f} tool radii: is the unit right?",)


def touch_point(surface: Surface, x: float, y: float) -> FloatArray:
    """Uppermost point (3,) in m of the surface on the vertical line through (x, y) in m.

    Raises
    ------
    FemError
        If the line misses the surface.
    """
    a, b, c = surface.corners.transpose(1, 0, 2)
    share = barycentric(a, b, c, np.array([x, y]))
    hit = share.min(axis=0) >= 0.0
    if not hit.any():
        low, high = surface.points.min(axis=0), surface.points.max(axis=0)
        raise FemError(
            f"tool.position = ({x:g}, {y:g}) m: is not above the surface, which reaches from "
            f"({low[0]:.4g}, {low[1]:.4g}) to ({high[0]:.4g}, {high[1]:.4g}) m"
        )
    height = np.einsum("kt,kt->t", share, np.stack((a[:, 2], b[:, 2], c[:, 2])))
    return np.array([x, y, float(height[hit].max())])


def _tool_edge(surface: Surface, place: FloatArray, radius: float) -> FloatArray:
    """Places (k, 3) in m of the tool's edge on the surface; at its place where all of it overhangs."""
    turn = np.linspace(0.0, 2.0 * np.pi, EDGE_PLACES, endpoint=False)
    x, y = place[0] + radius * np.cos(turn), place[1] + radius * np.sin(turn)
    found = []
    for a, b in zip(x, y, strict=True):
        try:
            found.append(touch_point(surface, a, b))
        except FemError:
            continue
    return np.array(found or [place])


def quadratic(points: FloatArray, tetrahedra: IntArray) -> tuple[FloatArray, IntArray]:
    """Nodes (N, 3) and 10-node elements (10, E) of tetrahedra (E, 4), mid-sides on the straight edges."""
    pairs = np.sort(tetrahedra[:, EDGES].reshape(-1, 2), axis=1)
    edges, number = np.unique(pairs, axis=0, return_inverse=True)
    middle = points[edges].mean(axis=1)
    elements = np.concatenate((tetrahedra, len(points) + number.reshape(-1, len(EDGES))), axis=1)
    return np.concatenate((points, middle)), np.ascontiguousarray(elements.T)


def _with_vertex(points: FloatArray, tetrahedra: IntArray, place: FloatArray) -> FloatArray:
    """The points with the nearest one on the outside moved to a place (3,)."""
    faces = np.sort(tetrahedra[:, FACES].reshape(-1, 3), axis=1)
    outer, count = np.unique(faces, axis=0, return_counts=True)
    outside = np.unique(outer[count == 1])
    moved = points.copy()
    moved[outside[np.linalg.norm(points[outside] - place, axis=1).argmin()]] = place
    return moved


def _layer_faces(elements: IntArray, layer: IntArray) -> tuple[IntArray, ...]:
    """For each layer the 6-node faces (6, T) through which one comes into it from outside or from the layers above."""
    number = {pair: 4 + n for n, pair in enumerate(EDGES)}
    local = [[*f, *(number[min(p), max(p)] for p in ((f[0], f[1]), (f[1], f[2]), (f[2], f[0])))] for f in FACES]
    faces = np.concatenate([elements[face] for face in local], axis=1)
    owner = np.tile(layer, len(FACES))
    _, first, inverse, count = np.unique(
        np.sort(faces[:3], axis=0), axis=1, return_index=True, return_inverse=True, return_counts=True
    )
    above = np.full(len(first), -1)  # least layer at each face, -1 outside
    least = np.full(len(first), len(owner))
    np.minimum.at(least, inverse.ravel(), owner)
    above[count == 2] = least[count == 2]
    return tuple(faces[:, (owner >= k) & (above[inverse.ravel()] < k)] for k in range(int(layer.max()) + 1))


def _upward(nodes: FloatArray, faces: IntArray) -> FloatArray:
    """Areas (T,) in m2 of faces seen from above, negative if they look down."""
    a, b, c = nodes[faces[:3], :2]
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    out: FloatArray = 0.5 * (ux * vy - uy * vx)
    return out


def _resting(nodes: FloatArray, faces: IntArray, up: FloatArray) -> BoolArray:
    """Faces (T,) that rest on the base: whole in the lowest part of the body, and looking down."""
    z = nodes[:, 2]
    top = z.min() + BASE_HEIGHT * np.ptp(z)
    down = up < -np.cos(np.radians(BASE_ANGLE)) * _areas(nodes, faces)
    out: BoolArray = down & (z[faces[:3]].max(axis=0) <= top)
    return out


def _areas(nodes: FloatArray, faces: IntArray) -> FloatArray:
    """Areas (T,) in m2 of faces."""
    a, b, c = nodes[faces[:3]]
    out: FloatArray = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return out


def _facing(nodes: FloatArray, faces: IntArray, up: FloatArray, place: FloatArray, radius: float) -> BoolArray:
    """Faces (T,) that look up and lie not far below the tool's middle."""
    middle = nodes[faces[:3], 2].mean(axis=0)
    out: BoolArray = (up > LOOKING_UP * _areas(nodes, faces)) & (middle > place[2] - 2.0 * radius)
    return out


def _touched(nodes: FloatArray, faces: IntArray, up: FloatArray, place: FloatArray, radius: float) -> BoolArray:
    """Faces (T,) whose middle lies under the tool."""
    centre = nodes[faces[:3]].mean(axis=0)
    inside = np.hypot(centre[:, 0] - place[0], centre[:, 1] - place[1]) < radius
    out: BoolArray = inside & _facing(nodes, faces, up, place, radius)
    return out


def _disc_load(nodes: FloatArray, faces: IntArray, up: FloatArray, place: FloatArray, radius: float) -> FloatArray:
    """Relative nodal forces (N,) of a traction, even as seen from above, on the part of the faces inside the circle.

    Faces that the circle cuts are summed over many small triangles, so that the mesh need not follow the tool.
    """
    facing = faces[:, _facing(nodes, faces, up, place, radius)]
    p, q, r = _small_triangles()
    x, y = (np.einsum("ks,kt->st", np.stack((p, q, r)), nodes[facing[:3], axis]) for axis in (0, 1))
    weight = (np.hypot(x - place[0], y - place[1]) < radius) * _upward(nodes, facing)
    shape = np.stack((p * (2 * p - 1), q * (2 * q - 1), r * (2 * r - 1), 4 * p * q, 4 * q * r, 4 * r * p))
    return np.bincount(facing.ravel(), (shape @ weight).ravel(), len(nodes)).astype(np.float64)


def _small_triangles() -> FloatArray:
    """Barycentric coordinates (3, s) of the middles of the equal parts of a triangle."""
    n = PARTS
    up = [(i + 1 / 3, j + 1 / 3) for i in range(n) for j in range(n - i)]
    down = [(i + 2 / 3, j + 2 / 3) for i in range(n) for j in range(n - i - 1)]
    p, q = np.array([*up, *down]).T / n
    return np.stack((p, q, 1.0 - p - q))


def _marked(count: int, faces: IntArray) -> BoolArray:
    out = np.zeros(count, dtype=np.bool_)
    out[faces.ravel()] = True
    return out
