"""The mesh of a specimen bounded by a surface: quadratic tetrahedra with the tool's place on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.mesh.solid import SolidMesh
from fem.mesh.surface.quality import MeshQuality


@dataclass(frozen=True)
class SurfaceMesh(SolidMesh):
    """Quadratic tetrahedra; z upwards as in the surface, the tool presses down.

    Attributes
    ----------
    layer_faces
        For each layer the 6-node triangles (6, T) of its outer side: corners and mid-sides.
    tool_load
        Vertical nodal forces (N,) of 1 N spread over the surface under the tool; they add up to -1.
    quality
        How good the mesh is.
    remarks
        What was repaired or is poor, in words.
    """

    layer_faces: tuple[IntArray, ...]
    tool_load: FloatArray
    quality: MeshQuality
    remarks: tuple[str, ...]

    def profile(self, values: FloatArray, r: FloatArray) -> FloatArray:
        """Nodal values (N,) on each layer's uppermost outer side at x distances r (m,) from the tool's axis, (L, m)."""
        x, y = self.axis_point
        places = np.stack((x + r, np.full_like(r, y)), axis=1)
        return np.stack([uppermost(self.nodes, faces, values, places) for faces in self.layer_faces])


def uppermost(nodes: FloatArray, faces: IntArray, values: FloatArray, places: FloatArray) -> FloatArray:
    """Values (m,) where vertical lines first meet triangles.

    Parameters
    ----------
    nodes
        Positions (N, 3) in m.
    faces
        6-node triangles (6, T) with straight sides.
    values
        Nodal values (N,), interpolated quadratically.
    places
        (x, y) of the lines, (m, 2) in m.

    Returns
    -------
    ndarray
        NaN where a line meets no triangle.
    """
    a, b, c = nodes[faces[:3]]
    out = np.full(len(places), np.nan)
    for n, place in enumerate(places):
        share = barycentric(a, b, c, place)
        hit = np.flatnonzero(share.min(axis=0) >= -1e-9)
        if hit.size:
            height = sum(share[k, hit] * corner[hit, 2] for k, corner in enumerate((a, b, c)))
            top = hit[int(np.argmax(height))]
            p, q, r = share[:, top]
            shape = (p * (2 * p - 1), q * (2 * q - 1), r * (2 * r - 1), 4 * p * q, 4 * q * r, 4 * r * p)
            out[n] = float(np.dot(shape, values[faces[:, top]]))
    return out


def barycentric(a: FloatArray, b: FloatArray, c: FloatArray, place: FloatArray) -> FloatArray:
    """Barycentric coordinates (3, T) of a place (2,) in triangles seen from above; -1 for upright triangles."""
    (ux, uy), (vx, vy) = (b - a)[:, :2].T, (c - a)[:, :2].T
    wx, wy = (place - a[:, :2]).T
    area = ux * vy - uy * vx
    upright = np.abs(area) <= 1e-12 * (ux**2 + uy**2 + vx**2 + vy**2)
    area = np.where(upright, 1.0, area)
    q, r = (wx * vy - wy * vx) / area, (ux * wy - uy * wx) / area
    return np.where(upright, -1.0, np.stack((1.0 - q - r, q, r)))
