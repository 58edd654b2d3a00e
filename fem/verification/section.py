"""Meshes of sections that are no layered specimen, and plane problems by the axisymmetric element.

Plane strain is axial symmetry far from the axis: a ring of radius `RING` (in widths of its section), whose curvature
costs about 1/RING. Plane stress at small strain is plane strain of another material.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fem.arrays import FloatArray
from fem.materials import LinearElastic
from fem.mesh.quads import Mesh, mesh_of_quads

RING = 1e6
PLANE_PERCENT = 2e-3  # what curvature and the round-off of the radius cost a ring, nearly incompressible too


def mapped_mesh(
    s: FloatArray, t: FloatArray, place: Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]
) -> Mesh:
    """Mesh of the grid lines s (n,) by t (m,), moved to (r, z) by `place`, which keeps the orientation."""
    rows = len(t)
    r, z = place(*(grid.ravel() for grid in np.meshgrid(s, t, indexing="ij")))
    corner = np.arange(rows * len(s)).reshape(-1, rows)[:-1, :-1].ravel()
    quads = np.stack((corner, corner + rows, corner + rows + 1, corner + 1))
    return mesh_of_quads(np.stack((r, z - z.max()), axis=1), quads, np.zeros(1))


def distorted_square(count: int, seed: int, start: float = 0.0) -> Mesh:
    """Unit square start <= r <= start + 1 of count x count quadrilaterals whose inner corners are off the grid."""
    line = np.linspace(0.0, 1.0, count + 1)
    generator = np.random.default_rng(seed)

    def place(s: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        inner = (s > 0.0) & (s < 1.0) & (t > 0.0) & (t < 1.0)
        shift = np.where(inner, generator.uniform(-0.25, 0.25, (2, len(s))) / count, 0.0)
        return start + s + shift[0], t + shift[1]

    return mapped_mesh(line, line, place)


def plane_stress_material(youngs_modulus: float, poisson_ratio: float) -> LinearElastic:
    """Material whose plane strain is the plane stress of the constants given.

    E (1 + 2 nu) / (1 + nu)^2 and nu / (1 + nu): stresses and displacements in the plane are the same (Timoshenko and
    Goodier, Theory of Elasticity, chapter 2).
    """
    whole = 1.0 + poisson_ratio
    return LinearElastic(youngs_modulus * (1.0 + 2.0 * poisson_ratio) / whole**2, poisson_ratio / whole)
