"""Tetrahedra that fill a surface and follow its layers, by fTetWild (Hu et al., ACM Trans. Graph. 39 (2020) 117).

The mesher gets a box, the surface, one offset surface for each layer interface and a sleeve round the tool, fills the
box and follows all of them within a tolerance. What lies outside is dropped, the rest is tagged by its centroids'
distance from the surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse as sp
import scipy.spatial
import skfem

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.errors import CheckpointError, FemError
from fem.kept_file import fingerprint, read_kept, write_kept
from fem.mesh.surface.own_process import tetrahedralize_apart
from fem.mesh.surface.surface_file import Surface

BOX_MARGIN = 0.1
TOLERANCE = 2e-3  # of the box's diagonal
TOLERANCE_OF_LAYER = 0.2
STOP_ENERGY = 20.0  # of the mesher's optimisation; mean ratios stay above 0.1
PASSES = 10
BACKGROUND = 14
CLOSE, CLOSE_LINES = 1.5, 6  # in tool radii from where it touches; lines for each of them
SLEEVE_SIDES = 64
SLEEVE_HEIGHTS = (-0.5, 0.2)  # in tool radii from the place it touches
TOLERANCE_OF_TOOL = 0.04  # of the tool's radius
FORMAT = "fem tetrahedra 1"


@dataclass(frozen=True)
class Refinement:
    """Wanted edge lengths.

    Attributes
    ----------
    place
        Where the tool's axis meets the surface, (3,) in m; the mesh is fine round it.
    radius
        Radius in m of the tool and of the fine region.
    edge
        Places (k, 3) in m of the tool's edge on the surface, where the traction or its gradient is singular.
    at_edge, fine, coarse
        Edge length in m there, under the tool and far away.
    growth
        Growth of the edge length per metre of distance.
    """

    place: FloatArray
    radius: float
    edge: FloatArray
    at_edge: float
    fine: float
    coarse: float
    growth: float

    def length(self, points: FloatArray) -> FloatArray:
        """Wanted edge length (n,) in m at points (n, 3)."""
        distance = np.maximum(np.linalg.norm(points - self.place, axis=1) - self.radius, 0.0)
        nearest, _ = scipy.spatial.KDTree(self.edge).query(points)
        graded = np.minimum(self.fine + self.growth * distance, self.at_edge + self.growth * nearest)
        out: FloatArray = np.minimum(self.coarse, graded)
        return out

    def grid(self, low: FloatArray, high: FloatArray) -> tuple[FloatArray, ...]:
        """Lines in x, y and z in m of a box's grid on which the lengths are told, close together at the tool."""
        near = self.radius * np.linspace(-CLOSE, CLOSE, round(2 * CLOSE * CLOSE_LINES) + 1)
        lines = [
            np.unique(np.concatenate((np.linspace(a, b, BACKGROUND), near[(x + near > a) & (x + near < b)] + x)))
            for a, b, x in zip(low, high, self.place, strict=True)
        ]
        return tuple(line[np.diff(line, prepend=-np.inf) > 1e-6 * self.radius] for line in lines)


def fill(surface: Surface, depths: FloatArray, refinement: Refinement) -> tuple[FloatArray, IntArray, IntArray]:
    """Tetrahedra of a checked surface.

    Parameters
    ----------
    surface
        Closed and looking outwards.
    depths
        Depths (L - 1,) in m of the layer interfaces below the surface.
    refinement
        Wanted edge lengths.

    Returns
    -------
    tuple of ndarray
        Points (P, 3) in m, tetrahedra (E, 4) of positive volume, layer (E,) of each.

    Raises
    ------
    FemError
        If the mesher is missing, finds nothing, or loses a layer.
    """
    points, tetrahedra = _tetrahedra(surface, depths, refinement)
    distance = signed_distance(surface, points[tetrahedra].mean(axis=1))
    inside = _largest_part(tetrahedra, distance > 0.0)
    layer = np.searchsorted(depths, distance[inside])
    for lost in set(range(len(depths) + 1)) - set(np.unique(layer).tolist()):
        raise FemError(
            f"{surface.label}: layer {lost + 1} from the surface has no element; the body may be thinner than the "
            f"layers above it (its largest depth is {distance.max():.3g} m)"
        )
    used, renumbered = np.unique(tetrahedra[inside], return_inverse=True)
    return points[used], renumbered.reshape(-1, 4), layer


def _largest_part(tetrahedra: IntArray, inside: BoolArray) -> BoolArray:
    """Of the tetrahedra inside (E,), those that hang together by their faces: none may dangle at an edge."""
    chosen = np.flatnonzero(inside)
    if chosen.size == 0:
        raise FemError("surface: the mesher found no tetrahedron inside it")
    faces = np.sort(tetrahedra[chosen][:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]], axis=2).reshape(-1, 3)
    order = np.lexsort(faces.T)
    equal = np.flatnonzero((np.diff(faces[order], axis=0) == 0).all(axis=1))
    first, second = order[equal] // 4, order[equal + 1] // 4
    links = sp.coo_array((np.ones(len(equal)), (first, second)), shape=(len(chosen), len(chosen)))
    _, part = sp.csgraph.connected_components(links, directed=False)
    out = np.zeros_like(inside)
    out[chosen[part == np.bincount(part).argmax()]] = True
    return out


def signed_distance(surface: Surface, places: FloatArray) -> FloatArray:
    """Distance (n,) in m of places (n, 3) from the surface, positive inside."""
    import pyvista

    cloud = pyvista.PolyData(places)
    found = cloud.compute_implicit_distance(_polydata(surface))
    out: FloatArray = -np.asarray(found["implicit_distance"], dtype=np.float64)
    return out


def _polydata(surface: Surface):  # type: ignore[no-untyped-def] # pyvista is not typed
    import pyvista

    faces = np.insert(surface.triangles, 0, 3, axis=1)
    return pyvista.PolyData(surface.points, faces=faces.ravel())


def _tetrahedra(surface: Surface, depths: FloatArray, refinement: Refinement) -> tuple[FloatArray, IntArray]:
    sleeve = _sleeve(refinement.place, refinement.radius)
    soup = [_box(surface), surface, sleeve, *(_offset(surface, depth) for depth in depths)]
    starts = np.cumsum([0, *(len(part.points) for part in soup)])
    points = np.concatenate([part.points for part in soup])
    triangles = np.concatenate([part.triangles + start for part, start in zip(soup, starts, strict=False)])
    diagonal = float(np.linalg.norm(soup[0].size))
    thinnest = float(np.diff(depths, prepend=0.0).min()) if len(depths) else diagonal
    low, high = soup[0].points.min(axis=0), soup[0].points.max(axis=0)
    background = skfem.MeshTet.init_tensor(*refinement.grid(low, high))
    found, tetrahedra = tetrahedralize_apart(
        vertices=points,
        faces=triangles.astype(np.int32),
        edge_length_abs=refinement.coarse,
        epsilon=min(
            TOLERANCE, TOLERANCE_OF_LAYER * thinnest / diagonal, TOLERANCE_OF_TOOL * refinement.radius / diagonal
        ),
        stop_energy=STOP_ENERGY,
        num_opt_iter=PASSES,
        disable_filtering=True,
        vtk_ordering=True,
        bg_vertices=np.ascontiguousarray(background.p.T),
        bg_tets=np.ascontiguousarray(background.t.T.astype(np.int32)),
        bg_values=refinement.length(background.p.T),
    )
    return found, _positive(found, tetrahedra)


def _positive(points: FloatArray, tetrahedra: IntArray) -> IntArray:
    """The tetrahedra with corners in right-handed order."""
    edges = points[tetrahedra[:, 1:]] - points[tetrahedra[:, :1]]
    turned = np.linalg.det(edges) < 0.0
    out = tetrahedra.copy()
    out[turned] = tetrahedra[turned][:, [0, 2, 1, 3]]
    return out


def _offset(surface: Surface, depth: float) -> Surface:
    """The surface moved inwards by a depth (m) along its normals; folds do no harm to the mesher."""
    normal = np.zeros_like(surface.points)
    for corner in range(3):
        np.add.at(normal, surface.triangles[:, corner], surface.area_vectors)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    return Surface(surface.points - depth * normal, surface.triangles)


def _sleeve(place: FloatArray, radius: float) -> Surface:
    """A short upright tube through the surface at the tool's edge, so that the mesh has an edge there."""
    theta = np.linspace(0.0, 2.0 * np.pi, SLEEVE_SIDES, endpoint=False)
    circle = radius * np.stack((np.cos(theta), np.sin(theta), np.zeros_like(theta)), axis=1) + place
    low, high = ([0.0, 0.0, radius * height] for height in SLEEVE_HEIGHTS)
    k = np.arange(SLEEVE_SIDES)
    following = (k + 1) % SLEEVE_SIDES
    lower = np.stack((k, following, k + SLEEVE_SIDES), axis=1)
    upper = np.stack((following, following + SLEEVE_SIDES, k + SLEEVE_SIDES), axis=1)
    return Surface(np.concatenate((circle + low, circle + high)), np.concatenate((lower, upper)))


def _box(surface: Surface) -> Surface:
    """A box round the surface."""
    low, high = surface.points.min(axis=0), surface.points.max(axis=0)
    margin = BOX_MARGIN * float((high - low).max())
    corner = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    triangles = [(a, b, c) for q in quads for a, b, c in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    return Surface(low - margin + corner * (high - low + 2.0 * margin), np.array(triangles))


def kept_filling(
    surface: Surface, depths: FloatArray, refinement: Refinement, keep: Path | None
) -> tuple[FloatArray, IntArray, IntArray]:
    """Tetrahedra of a checked surface, from a file where it holds those of the same surface, depths and lengths.

    Parameters
    ----------
    surface, depths, refinement
        See :func:`fem.mesh.surface.filling.fill`.
    keep
        The file; one that is not there, damaged or another's is replaced. None keeps nothing.

    Returns
    -------
    tuple of ndarray
        Points (P, 3) in m, tetrahedra (E, 4) of positive volume, layer (E,) of each.

    Raises
    ------
    FemError
        If the surface cannot be filled, or the file not written.
    """
    if keep is None:
        return fill(surface, depths, refinement)
    lengths = (refinement.radius, refinement.at_edge, refinement.fine, refinement.coarse, refinement.growth)
    shapes = (surface.points, surface.triangles, np.asarray(depths), refinement.place, refinement.edge)
    owner = fingerprint(lengths, shapes)
    try:
        found = read_kept(keep, FORMAT, owner)
    except CheckpointError:
        found = None
    if found is not None:
        return found["points"], found["tetrahedra"], found["layer"]
    points, tetrahedra, layer = fill(surface, depths, refinement)
    write_kept(keep, FORMAT, owner, {"points": points, "tetrahedra": tetrahedra, "layer": layer})
    return points, tetrahedra, layer
