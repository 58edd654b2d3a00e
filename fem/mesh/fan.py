"""Fans of elements round a point of a plane mesh where the stress is singular.

Round the point from which a flat face is held (the edge of a stuck tool, the rim of a hole) the displacement of an
incompressible body goes with the square root of the distance (M. L. Williams, Journal of Applied Mechanics 19 (1952)
526). A fan is rings of elements round the point, the innermost ones collapsed to triangles. With their mid-side nodes
at a quarter of the way from the point these hold the square root exactly (R. S. Barsoum, International Journal for
Numerical Methods in Engineering 10 (1976) 25).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray

AT_BOUNDARY = 1e-9  # in half widths of the box


@dataclass(frozen=True)
class Fan:
    """A box round a point of the upper or the lower face, meshed by rays from the point.

    Under a stuck tool the material turns round the sharp edge. One element spanning the right angle under the
    edge cannot follow and folds; rays share the turn among several elements.

    Attributes
    ----------
    radius
        Radius of the point in m.
    half_width
        Half width and height of the box in m; its sides must be grid lines.
    rings
        Sizes of the rings relative to the box, decreasing from 1.
    depth
        Depth of the point in m; 0 on the upper face, otherwise it is on the lower one.
    square_root
        Whether the innermost elements hold the square root of the distance.
    """

    radius: float
    half_width: float
    rings: tuple[float, ...]
    depth: float = 0.0
    square_root: bool = False

    @property
    def point(self) -> FloatArray:
        """(r, z) in m."""
        return np.array([self.radius, -self.depth])

    def opened(self, points: FloatArray, quads: IntArray) -> tuple[FloatArray, IntArray]:
        """Corners (P, 2) in m and quadrilaterals (4, E) with the rectangles in the box replaced."""
        offset = np.abs(points - self.point).max(axis=1) / self.half_width
        kept = quads[:, ~(offset[quads] <= 1.0 + AT_BOUNDARY).all(axis=0)]
        outer = self._around(points, np.flatnonzero(np.abs(offset - 1.0) <= AT_BOUNDARY))
        rays, pieces, fans = points[outer] - self.point, [points], [kept]
        for ring in (*self.rings[1:], 0.0):
            inner = sum(len(piece) for piece in pieces) + np.arange(len(outer))
            pieces.append(self.point + ring * rays)
            fans.append(np.stack((outer[:-1], outer[1:], inner[1:], inner[:-1])))
            outer = inner
        used, renumbered = np.unique(np.concatenate(fans, axis=1), return_inverse=True)
        return np.concatenate(pieces)[used], renumbered.reshape(4, -1)

    def _around(self, points: FloatArray, side: IntArray) -> IntArray:
        """Nodes of the box's sides counter-clockwise, from one end of the free face to the other."""
        r, z = (points[side] - self.point).T
        turn = np.arctan2(np.abs(z), r)
        return side[np.argsort(turn if self.depth > 0.0 else -turn)]

    def gathered(self, nodes: FloatArray, elements: IntArray) -> tuple[FloatArray, IntArray]:
        """Nodes (N, 2) in m and elements (9, E) with one node at the point, and those next to it in place."""
        at_point: BoolArray = np.abs(nodes - self.point).max(axis=1) <= AT_BOUNDARY * self.half_width
        if self.square_root:
            nodes = self._drawn_in(nodes, elements, at_point)
        first = np.arange(len(nodes))
        first[at_point] = np.flatnonzero(at_point)[0]
        used, renumbered = np.unique(first[elements], return_inverse=True)
        return nodes[used], renumbered.reshape(elements.shape)

    def _drawn_in(self, nodes: FloatArray, elements: IntArray, at_point: BoolArray) -> FloatArray:
        """The nodes with the mid-side ones next to the point where the square root wants them."""
        corners, middles = elements[:4], elements[4:8]
        ends = np.stack((corners, np.roll(corners, -1, axis=0)))
        collapsed = at_point[corners].sum(axis=0) == 2
        towards = middles[(at_point[ends].sum(axis=0) == 1) & collapsed]
        inner = np.unique(np.concatenate((towards, elements[8, collapsed])))
        out = nodes.copy()
        out[inner] = self.point + 0.5 * (nodes[inner] - self.point)
        return out
