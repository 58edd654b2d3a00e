"""NAFEMS LE1: a quarter of an elliptic membrane in plane stress, pulled on its outer edge.

Inner ellipse with half axes 2 and 1 m, outer one 3.25 and 2.75 m, E = 210 GPa, nu = 0.3, 10 MPa outwards on the outer
edge. The tangential stress where the inner edge meets the long axis is 92.7 MPa (The Standard NAFEMS Benchmarks, 1990).
"""

from __future__ import annotations

import numpy as np

from fem.arrays import FloatArray
from fem.verification.body import Body, free_of_ties
from fem.verification.case import Case, Quantity
from fem.verification.section import RING, mapped_mesh, plane_stress_material

INNER, OUTER = np.array([2.0, 1.0]), np.array([3.25, 2.75])
YOUNGS_MODULUS, POISSON_RATIO, TENSION = 210e9, 0.3, 10e6
REFERENCE, ALLOWED_PERCENT = 92.7, 0.1
SOURCE = "The Standard NAFEMS Benchmarks (1990), LE1"
ACROSS, AROUND, GROWTH = 20, 40, 6.0
ON_EDGE = 0.995  # of the outer ellipse's equation: chords lie above it, the next nodes inwards below


def cases() -> tuple[Case, ...]:
    """The one case."""
    return (Case("nafems_le1", SOURCE, membrane),)


def membrane() -> tuple[Quantity, ...]:
    """Tangential stress at the end of the inner long axis."""
    across = (np.geomspace(1.0, GROWTH, ACROSS + 1) - 1.0) / (GROWTH - 1.0)
    mesh = mapped_mesh(across, np.linspace(0.0, 1.0, AROUND + 1), _place)
    x, y = mesh.nodes[:, 0] - RING, mesh.nodes[:, 1] - mesh.nodes[:, 1].min()
    outer = (x / OUTER[0]) ** 2 + (y / OUTER[1]) ** 2 > ON_EDGE
    body = Body(
        mesh,
        plane_stress_material(YOUNGS_MODULUS, POISSON_RATIO),
        np.stack((np.asarray(x == 0.0), mesh.base)),
        free_of_ties(mesh),
    )
    moved = body.solve_linear(body.pull(outer, TENSION))
    stress = body.corner_stress(moved, (RING + INNER[0], float(mesh.nodes[:, 1].min())))
    return (Quantity("", REFERENCE, 1e-6 * float(stress[4]), "MPa", ALLOWED_PERCENT, body.numbering.count),)


def _place(across: FloatArray, around: FloatArray) -> tuple[FloatArray, FloatArray]:
    angle, axes = 0.5 * np.pi * around, INNER[:, None] + across * (OUTER - INNER)[:, None]
    return RING + axes[0] * np.cos(angle), axes[1] * np.sin(angle)
