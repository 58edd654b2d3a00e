"""Three-dimensional meshes, and the block: a plane grid round a disc, drawn down through the layers.

The grid is a bulged square, circles, and a square border. The circles follow the tool's edge and the rim of a hole;
further out they turn into the sides of the block. Round an off-centre tool their centres move from the tool's axis to
the specimen's.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.mesh.quads import Mesh, along_row

BULGE = 0.18  # how much the corners of the inner square are pulled in, so that the ring round it is even


@dataclass(frozen=True)
class SolidMesh:
    """Quadratic elements in (x, y, z), z upwards with the top face at z = 0.

    Attributes
    ----------
    nodes
        Reference positions (N, 3) in m.
    elements
        Node numbers (n, E) in scikit-fem's order.
    element
        Kind: "hex27", "hex20" or "tet10".
    layer
        Layer of each element (E,), 0 on top.
    axis_point
        (x, y) in m where the tool's axis meets the surface.
    images
        How often the mesh is there with its mirror images: 4 (quarter), 2 (half) or 1.
    mirror_x, mirror_y
        Nodes (N,) on the mirror planes, whose displacement u_x or u_y is zero.
    top, base, border
        Nodes (N,) on the top face, the lower face and the sides.
    interfaces
        For each layer the nodes of its top face from the tool's axis along +x, corners and mid-sides in turn.
    top_elements
        Elements (T,) with a face on the top face.
    """

    nodes: FloatArray
    elements: IntArray
    element: str
    layer: IntArray
    axis_point: tuple[float, float]
    images: int
    mirror_x: BoolArray
    mirror_y: BoolArray
    top: BoolArray
    base: BoolArray
    border: BoolArray
    interfaces: tuple[IntArray, ...]
    top_elements: IntArray

    @property
    def specimen_distance(self) -> FloatArray:
        """Distance of the nodes (N,) in m from the specimen's axis."""
        out: FloatArray = np.hypot(self.nodes[:, 0], self.nodes[:, 1])
        return out

    @property
    def tool_distance(self) -> FloatArray:
        """Distance of the nodes (N,) in m from the tool's axis."""
        x, y = self.axis_point
        out: FloatArray = np.hypot(self.nodes[:, 0] - x, self.nodes[:, 1] - y)
        return out

    def profile(self, values: FloatArray, r: FloatArray) -> FloatArray:
        """Nodal values (N,) on each layer's top face at distances r (m,) from the tool's axis, (L, m)."""
        return np.stack([along_row(self.nodes[row, 0] - self.axis_point[0], values[row], r) for row in self.interfaces])


AnyMesh: TypeAlias = Mesh | SolidMesh


@dataclass(frozen=True)
class DiscGrid:
    """What the grid consists of.

    Attributes
    ----------
    rings
        Radii (n,) in m, increasing: the half side of the inner square, then circles, then the border's half side.
    pieces
        Elements over half a side of the inner square; twice as many over a quarter of the circles.
    quarters
        1 (x and y from the axis outwards) or 2 (y only).
    centre
        x in m of the tool's axis.
    tool_radius
        Radius in m up to which the circles are centred on the tool's axis.
    centred_from
        Radius in m from which on they are centred at x = 0.
    round_to
        Radius in m up to which the rings are round.
    """

    rings: FloatArray
    pieces: int
    quarters: int
    centre: float
    tool_radius: float
    centred_from: float
    round_to: float

    @property
    def _half_steps(self) -> int:
        return 2 * self.pieces

    @property
    def _angles(self) -> int:
        return 2 * self._half_steps * self.quarters + 1

    def points(self) -> FloatArray:
        """Node positions (N, 2) in m: the square row by row along y, then ring by ring."""
        square = self.rings[0] * self._square() + [self.centre, 0.0]
        corners = [square[self._square_boundary()], *(self._circle(radius) for radius in self.rings[1:])]
        rings = [ring for k in range(1, len(corners)) for ring in (0.5 * (corners[k - 1] + corners[k]), corners[k])]
        return np.concatenate([square, *rings])

    def elements(self) -> IntArray:
        """Node numbers (3, 3, E): two steps outwards (or along x), two counter-clockwise (or along y)."""
        n, angles = self._half_steps, self._angles
        square = np.arange((self.quarters * n + 1) * (n + 1)).reshape(-1, n + 1)
        first = np.arange(2 * (len(self.rings) - 1) * angles).reshape(-1, angles) + square.size
        polar = np.concatenate((self._square_boundary()[None], first))
        return np.concatenate((_patches(square), _patches(polar)), axis=2)

    def row(self) -> IntArray:
        """Nodes from the tool's axis along +x."""
        n, square = self._half_steps, (self.quarters * self._half_steps + 1) * (self._half_steps + 1)
        start = (self.quarters - 1) * n * (n + 1)
        inner = start + np.arange(n + 1) * (n + 1)
        return np.concatenate((inner, square + np.arange(2 * (len(self.rings) - 1)) * self._angles))

    def _square(self) -> FloatArray:
        n = self._half_steps
        u, v = np.meshgrid(np.arange(-n * (self.quarters - 1), n + 1) / n, np.arange(n + 1) / n, indexing="ij")
        return np.stack((u * (1 - BULGE * v), v * (1 - BULGE * np.abs(u))), axis=-1).reshape(-1, 2)

    def _square_boundary(self) -> IntArray:
        """Nodes of the square at the angles of the rings."""
        n, left = self._half_steps, self._half_steps * (self.quarters - 1)
        up = [(n, j) for j in range(n)]
        over = [(i, n) for i in range(n, -left - 1, -1)]
        down = [(-n, j) for j in range(n - 1, -1, -1)] if self.quarters == 2 else []
        return np.array([(i + left) * (n + 1) + j for i, j in (*up, *over, *down)])

    def _circle(self, radius: float) -> FloatArray:
        theta = np.linspace(0.0, 0.5 * np.pi * self.quarters, self._angles)
        direction = np.stack((np.cos(theta), np.sin(theta)), axis=1)
        direction[np.abs(direction) < 1e-12] = 0.0
        squareness = max(0.0, (radius - self.round_to) / (self.rings[-1] - self.round_to))
        stretch = 1.0 + squareness**2 * (1.0 / np.abs(direction).max(axis=1, keepdims=True) - 1.0)
        share = np.clip((radius - self.tool_radius) / (self.centred_from - self.tool_radius), 0.0, 1.0)
        out: FloatArray = radius * stretch * direction + [self.centre * (1.0 - share), 0.0]
        return out


def _patches(grid: IntArray) -> IntArray:
    """All 3 x 3 patches at every second place of a grid, (3, 3, E)."""
    first, second = (slice(None, -2, 2), slice(1, -1, 2), slice(2, None, 2)), range(3)
    return np.array([[grid[first[a]][:, first[b]].ravel() for b in second] for a in second])


def build_block(
    grid: DiscGrid, depth_lines: FloatArray, layer_tops: FloatArray, places: FloatArray, element: str
) -> SolidMesh:
    """Mesh of a block.

    Parameters
    ----------
    grid
        The plane grid.
    depth_lines, layer_tops
        Depths (m,) in m, increasing from 0, and those (L,) among them of the layers' top faces.
    places, element
        Reference coordinates (n, 3) of an element's nodes, all of 0, 1/2 or 1, and its kind, "hex27" or "hex20".
    """
    plane, patches = grid.points(), grid.elements()
    count, middle = len(plane), 0.5 * (depth_lines[1:] + depth_lines[:-1])
    depths = np.concatenate((depth_lines[:1], np.insert(depth_lines[1:], range(len(middle)), middle)))
    elements = _drawn_down(patches, count, len(middle), places)
    layer = np.tile(np.searchsorted(layer_tops, middle, side="right") - 1, patches.shape[2])
    nodes = np.concatenate((np.tile(plane, (len(depths), 1)), -np.repeat(depths, count)[:, None]), axis=1)
    used, renumbered = np.unique(elements, return_inverse=True)
    x, y, z = nodes[used].T
    outer = grid.rings[-1] * (1.0 - 1e-9)
    return SolidMesh(
        nodes[used],
        renumbered.reshape(elements.shape),
        element,
        layer,
        axis_point=(grid.centre, 0.0),
        images=4 // grid.quarters,
        mirror_x=np.asarray((x == 0.0) & (grid.quarters == 1)),
        mirror_y=np.asarray(y == 0.0),
        top=np.asarray(z == 0.0),
        base=np.asarray(z == z.min()),
        border=np.asarray((np.abs(x) >= outer) | (y >= outer)),
        interfaces=tuple(
            np.searchsorted(used, grid.row() + count * int(np.flatnonzero(depths == top)[0])) for top in layer_tops
        ),
        top_elements=np.arange(patches.shape[2]) * len(middle),
    )


def _drawn_down(patches: IntArray, count: int, rows: int, places: FloatArray) -> IntArray:
    """Nodes (n, E) of the elements of a plane grid of patches (3, 3, P) with `count` nodes, in rows of elements."""
    a, b, c = np.rint(2.0 * places).astype(np.int64).T
    level = 2 * np.arange(rows)[None, :] + 2 - c[:, None]
    out: IntArray = (patches[a, b][:, :, None] + count * level[:, None, :]).reshape(len(places), -1)
    return out
