"""The tensor-product mesh of a layered specimen, with a fan of elements round the tool's edge if wanted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.mesh.quads import Mesh, mesh_of_quads


@dataclass(frozen=True)
class Fan:
    """A box round the tool's edge meshed by rays from the edge, collapsed quadrilaterals in its middle.

    Under a stuck tool the material turns round the sharp edge. One element spanning the right angle under the
    edge cannot follow and folds; rays share the turn among several elements.

    Attributes
    ----------
    radius
        Radius of the edge in m.
    half_width
        Half width and depth of the box in m; its sides must be grid lines.
    rings
        Sizes of the rings relative to the box, decreasing from 1.
    """

    radius: float
    half_width: float
    rings: tuple[float, ...]


def build_mesh(r_lines: FloatArray, depth_lines: FloatArray, layer_tops: FloatArray, fan: Fan | None = None) -> Mesh:
    """Mesh of the rectangles between grid lines.

    Parameters
    ----------
    r_lines
        Radii (n,) in m, increasing from 0.
    depth_lines
        Depths (m,) in m, increasing from 0.
    layer_tops
        Depths (L,) of the layers' top faces in m, each one of `depth_lines`.
    fan
        Replaces the rectangles in its box.
    """
    rows = len(depth_lines)
    r, depth = (grid.ravel() for grid in np.meshgrid(r_lines, depth_lines, indexing="ij"))
    points = np.stack((r, -depth), axis=1)
    corner = np.arange(len(r)).reshape(-1, rows)[:-1, 1:].ravel()
    quads = np.stack((corner, corner + rows, corner + rows - 1, corner - 1))
    if fan is not None:
        points, quads = _with_fan(points, quads, fan)
    return mesh_of_quads(points, quads, layer_tops)


def _with_fan(points: FloatArray, quads: IntArray, fan: Fan) -> tuple[FloatArray, IntArray]:
    edge = np.array([fan.radius, 0.0])
    offset = np.abs(points - edge).max(axis=1)
    limit = fan.half_width * (1.0 + 1e-9)
    kept = quads[:, ~(offset[quads] <= limit).all(axis=0)]
    side = np.flatnonzero((offset <= limit) & (offset >= fan.half_width * (1.0 - 1e-9)))
    angle = np.arctan2(-points[side, 1], points[side, 0] - fan.radius)
    outer = side[np.argsort(-angle)]
    rays, pieces, fans = points[outer] - edge, [points], [kept]
    for ring in (*fan.rings[1:], 0.0):
        inner = sum(len(piece) for piece in pieces) + np.arange(len(outer))
        pieces.append(edge + ring * rays)
        fans.append(np.stack((outer[:-1], outer[1:], inner[1:], inner[:-1])))
        outer = inner
    used, renumbered = np.unique(np.concatenate(fans, axis=1), return_inverse=True)
    return np.concatenate(pieces)[used], renumbered.reshape(4, -1)
