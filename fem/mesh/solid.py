"""Three-dimensional meshes, and the node sets every part of the solver works with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.mesh.quads import Mesh, along_row


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
