"""Meshes of biquadratic quadrilaterals, and the node sets every part of the solver works with.

The mesh of a layered specimen is a tensor product, with fans of elements (:mod:`fem.mesh.fan`) round the tool's edge
and the rim of a hole if wanted. The two sides of an interface may be parted: nodes of their own, at the same places at
rest.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace

import numpy as np
import skfem

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.mesh.fan import Fan


@dataclass(frozen=True)
class Mesh:
    """9-node quadrilaterals in (r, z), z upwards with the top face at z = 0.

    Attributes
    ----------
    nodes
        Reference positions (N, 2) in m.
    elements
        Node numbers (9, E): four corners around, the four mid-sides after them, the centre.
    layer
        Layer of each element (E,), 0 on top.
    axis, top, base, border
        Nodes (N,) on the axis, the top face, the lower face and the outer border.
    interfaces
        For each layer the nodes of its top face from the axis outwards, corners and mid-sides in turn.
    undersides
        For each layer but the last the nodes of its lower face in the same order: those of the next top face, or
        where the interface is split nodes at the same places (see :mod:`fem.mesh.quads`).
    """

    nodes: FloatArray
    elements: IntArray
    layer: IntArray
    axis: BoolArray
    top: BoolArray
    base: BoolArray
    border: BoolArray
    interfaces: tuple[IntArray, ...]
    undersides: tuple[IntArray, ...]

    @property
    def radius(self) -> float:
        """Radius of the outer border in m."""
        return float(self.nodes[:, 0].max())

    @property
    def specimen_distance(self) -> FloatArray:
        """Distance of the nodes (N,) in m from the specimen's axis, which is the tool's."""
        out: FloatArray = self.nodes[:, 0]
        return out

    @property
    def tool_distance(self) -> FloatArray:
        """Distance of the nodes (N,) in m from the tool's axis."""
        return self.specimen_distance

    def profile(self, values: FloatArray, r: FloatArray) -> FloatArray:
        """Nodal values (N,) on each layer's top face at distances r (m,) from the tool's axis, (L, m)."""
        return np.stack([along_row(self.nodes[row, 0], values[row], r) for row in self.interfaces])


def mesh_of_quads(points: FloatArray, quads: IntArray, layer_tops: FloatArray, fans: Iterable[Fan] = ()) -> Mesh:
    """Biquadratic mesh of quadrilaterals, its nodes numbered by scikit-fem.

    Parameters
    ----------
    points
        Corners (P, 2) in m. A quadrilateral may be collapsed to a triangle: two corners at one place.
    quads
        Corner numbers (4, E) around each quadrilateral.
    layer_tops
        Depths (L,) of the layers' top faces in m, from 0.
    fans
        Whose nodes at their points become one each.
    """
    mesh = skfem.MeshQuad(np.ascontiguousarray(points.T), np.ascontiguousarray(quads))
    dofs = skfem.Dofs(mesh, skfem.ElementQuad2())
    elements = np.asarray(dofs.element_dofs, dtype=np.int64)
    corners = mesh.p[:, mesh.t]
    middle, centre = 0.5 * (corners + np.roll(corners, -1, axis=1)), corners.mean(axis=1, keepdims=True)
    nodes: FloatArray = np.empty((dofs.N, 2))
    nodes[elements.ravel()] = np.concatenate((corners, middle, centre), axis=1).reshape(2, -1).T
    for fan in fans:
        nodes, elements = fan.gathered(nodes, elements)
    r, z = nodes.T
    interfaces = tuple(_row(r, np.flatnonzero(z == -depth)) for depth in layer_tops)
    return Mesh(
        nodes,
        elements,
        layer=np.searchsorted(layer_tops, -z[elements[8]]) - 1,
        axis=np.asarray(r == 0.0),
        top=np.asarray(z == 0.0),
        base=np.asarray(z == z.min()),
        border=np.asarray(r == r.max()),
        interfaces=interfaces,
        undersides=interfaces[1:],
    )


def _row(r: FloatArray, row: IntArray) -> IntArray:
    """Nodes of a row ordered by r, one for each place."""
    places, first = np.unique(r[row], return_index=True)
    del places
    return row[first]


def ring_areas(r: FloatArray) -> FloatArray:
    """Area (m,) in m2 of each node of a row at radii r (m,) in m, corners and mid-sides in turn, by Simpson's rule."""
    width = (r[2::2] - r[:-2:2]) / 6.0
    area = np.zeros(len(r))
    area[:-2:2] += width * r[:-2:2]
    area[1:-1:2] = 4.0 * width * r[1:-1:2]
    area[2::2] += width * r[2::2]
    return 2.0 * np.pi * area


def along_row(place: FloatArray, values: FloatArray, r: FloatArray) -> FloatArray:
    """Interpolation over a row of nodes by the elements' own shape functions, of values as of places.

    Parameters
    ----------
    place
        Distances (2 n + 1,) in m of the nodes from the row's start, increasing; middle nodes in the middle or nearer to
        an end, as close as a quarter of the way.
    values
        Values (2 n + 1,) at the nodes.
    r
        Where to interpolate, (m,) in m.

    Returns
    -------
    ndarray
        Values (m,); NaN beyond the end of the row.
    """
    lines = place[::2]
    column = np.clip(np.searchsorted(lines, r, side="right") - 1, 0, len(lines) - 2)
    s = _along_element(place[2 * column], place[2 * column + 1], place[2 * column + 2], r)
    first, middle, last = values[2 * column], values[2 * column + 1], values[2 * column + 2]
    inside = first * (1 - s) * (1 - 2 * s) + middle * 4 * s * (1 - s) + last * s * (2 * s - 1)
    return np.where(r <= lines[-1] * (1 + 1e-12), inside, np.nan)


def _along_element(start: FloatArray, middle: FloatArray, end: FloatArray, r: FloatArray) -> FloatArray:
    """Element coordinates (m,) from 0 to 1 of places: the root of start + slope s + bend s^2 = r."""
    slope, bend = 4.0 * middle - 3.0 * start - end, 2.0 * (start + end - 2.0 * middle)
    beyond = np.maximum(r - start, 0.0)
    root = slope + np.sqrt(np.maximum(slope**2 + 4.0 * bend * beyond, 0.0))
    s: FloatArray = np.divide(2.0 * beyond, root, out=np.zeros_like(beyond), where=root > 0.0)
    return s


def split_interfaces(mesh: Mesh, above: Collection[int]) -> Mesh:
    """The mesh with the lower faces of some layers parted from what is below them.

    The nodes on the axis and on the outer border, which cannot slide, stay those of both sides.

    Parameters
    ----------
    mesh
        A mesh whose layers are joined.
    above
        Numbers of the layers, 0 on top, whose lower faces get nodes of their own.
    """
    for layer in above:
        mesh = _split_below(mesh, layer)
    return mesh


def _split_below(mesh: Mesh, layer: int) -> Mesh:
    row, count = mesh.interfaces[layer + 1], len(mesh.nodes)
    parted = row[~(mesh.axis | mesh.border)[row]]
    twin = np.arange(count)
    twin[parted] = count + np.arange(len(parted))
    upper = mesh.layer == layer
    elements = mesh.elements.copy()
    elements[:, upper] = twin[elements[:, upper]]
    undersides = list(mesh.undersides)
    undersides[layer] = twin[row]
    origin = np.concatenate((np.arange(count), parted))
    return replace(
        mesh,
        nodes=mesh.nodes[origin],
        elements=elements,
        axis=mesh.axis[origin],
        top=mesh.top[origin],
        base=mesh.base[origin],
        border=mesh.border[origin],
        undersides=tuple(undersides),
    )


def build_mesh(r_lines: FloatArray, depth_lines: FloatArray, layer_tops: FloatArray, fans: Iterable[Fan] = ()) -> Mesh:
    """Mesh of the rectangles between grid lines.

    Parameters
    ----------
    r_lines
        Radii (n,) in m, increasing from 0.
    depth_lines
        Depths (m,) in m, increasing from 0.
    layer_tops
        Depths (L,) of the layers' top faces in m, each one of `depth_lines`.
    fans
        Each replaces the rectangles in its box.
    """
    rows, fans = len(depth_lines), tuple(fans)
    r, depth = (grid.ravel() for grid in np.meshgrid(r_lines, depth_lines, indexing="ij"))
    points = np.stack((r, -depth), axis=1)
    corner = np.arange(len(r)).reshape(-1, rows)[:-1, 1:].ravel()
    quads = np.stack((corner, corner + rows, corner + rows - 1, corner - 1))
    for fan in fans:
        points, quads = fan.opened(points, quads)
    return mesh_of_quads(points, quads, layer_tops, fans)
