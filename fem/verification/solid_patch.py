"""Patch tests in three dimensions: a linear displacement on the border must go on inside, on a distorted mesh.

The mesh of tetrahedra has straight sides by construction and is not distorted.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from fem.materials import LinearElastic
from fem.verification.body import worst
from fem.verification.case import Case, Quantity
from fem.verification.cube import cube, equations, solve_linear

KINDS = (("hex27", 0.3), ("hex27", 0.4999), ("hex20", 0.3), ("tet10", 0.3), ("tet10", 0.4999))
GRADIENT = 1e-2 * np.array([[1.0, 2.0, -1.0], [0.5, -2.0, 3.0], [1.0, 1.0, 1.0]])  # its trace is zero
COUNT, BEND = 2, 0.05
ALLOWED_PERCENT = 1e-6
SOURCE = "uniform displacement gradient (patch test of Irons)"


def cases() -> tuple[Case, ...]:
    """Each element, nearly incompressible too where it has a pressure of its own."""
    return tuple(Case(f"patch_{name}/nu_{nu:g}", SOURCE, partial(patch, name, nu)) for name, nu in KINDS)


def patch(element: str, poisson_ratio: float) -> tuple[Quantity, ...]:
    """Three components of the displacement gradient at the Gauss point where each is farthest off."""
    mesh = cube(element, COUNT, 0.0 if element == "tet10" else BEND)
    exact = GRADIENT @ mesh.nodes.T
    system = equations(mesh, LinearElastic(1e5, poisson_ratio), np.tile(mesh.base, (3, 1)), 0.0)
    system = system.displaced(mesh.elements, exact * mesh.base)
    y = solve_linear(system, np.zeros(system.numbering.count))
    found = system.elements.geometry.gradient(system.element_displacement(y))
    return tuple(
        Quantity(name, GRADIENT[i, j], worst(found[3 * i + j], GRADIENT[i, j]), "", ALLOWED_PERCENT, len(y))
        for name, i, j in (("xx", 0, 0), ("yz", 1, 2), ("zx", 2, 0))
    )
