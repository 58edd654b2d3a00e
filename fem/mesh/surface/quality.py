"""How good a mesh of tetrahedra is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray, IntArray

POOR = 0.1


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
