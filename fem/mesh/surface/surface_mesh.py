"""The mesh of a specimen bounded by a surface: quadratic tetrahedra, the tool's place on them, their quality."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.mesh.solid import SolidMesh

POOR = 0.1


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


@dataclass(frozen=True)
class MeshQuality:
    """Shape of the tetrahedra, and how well they fill the surface.

    Attributes
    ----------
    count
        Number of tetrahedra.
    least, mean
        Mean ratio 12 (3 V)^(2/3) / (sum of squared edges): 1 for the regular tetrahedron, 0 for a flat one.
    poor
        Share of tetrahedra below 0.1.
    volume_error
        Volume of all tetrahedra over that of the surface, less 1.
    layer_volume
        Volume of each layer in m3, (L,).
    """

    count: int
    least: float
    mean: float
    poor: float
    volume_error: float
    layer_volume: FloatArray

    def __str__(self) -> str:
        """One sentence."""
        return (
            f"{self.count} tetrahedra, mean ratio {self.mean:.2f} on average, {self.least:.3f} at least, "
            f"{100 * self.poor:.2f} % below {POOR:g}; volume {100 * self.volume_error:+.2f} % off the surface's"
        )


def tetrahedron_volume(corners: FloatArray) -> FloatArray:
    """Signed volumes (E,) in m3 of corners (E, 4, 3)."""
    edges = corners[:, 1:] - corners[:, :1]
    out: FloatArray = np.linalg.det(edges) / 6.0
    return out


def mean_ratio(corners: FloatArray) -> FloatArray:
    """Mean ratio (E,) of corners (E, 4, 3)."""
    first, second = np.triu_indices(4, 1)
    squared = ((corners[:, first] - corners[:, second]) ** 2).sum(axis=(1, 2))
    out: FloatArray = 12.0 * np.cbrt(3.0 * np.abs(tetrahedron_volume(corners))) ** 2 / squared
    return out


def measure_quality(points: FloatArray, tetrahedra: IntArray, layer: IntArray, volume: float) -> MeshQuality:
    """Quality of tetrahedra (E, 4) with layers (E,) that fill a surface of a volume (m3)."""
    corners = points[tetrahedra]
    ratio, volumes = mean_ratio(corners), np.abs(tetrahedron_volume(corners))
    return MeshQuality(
        len(tetrahedra),
        float(ratio.min()),
        float(ratio.mean()),
        float((ratio < POOR).mean()),
        float(volumes.sum() / volume - 1.0),
        np.bincount(layer, volumes).astype(np.float64),
    )
