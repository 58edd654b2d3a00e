"""Thick-walled cylinder under internal pressure, plane strain (Lame).

sigma_t(r) = p a^2 (1 + b^2 / r^2) / (b^2 - a^2), u(r) = (1 + nu) p a^2 ((1 - 2 nu) r + b^2 / r) / (E (b^2 - a^2))
(Timoshenko and Goodier, Theory of Elasticity, chapter 4).
"""

from __future__ import annotations

from functools import partial

import numpy as np

from fem.materials import LinearElastic
from fem.verification.body import Body, free_of_ties
from fem.verification.case import Case, Quantity
from fem.verification.section import mapped_mesh

INNER, OUTER, HEIGHT, PRESSURE, YOUNGS_MODULUS = 0.05, 0.1, 0.01, 10e6, 210e9
POISSON_RATIOS = (0.3, 0.499)
ELEMENTS = 24
ALLOWED_PERCENT = 0.1
SOURCE = "Lame (Timoshenko and Goodier, Theory of Elasticity, chapter 4)"


def cases() -> tuple[Case, ...]:
    """One for each Poisson's ratio."""
    return tuple(Case(f"lame_cylinder/nu_{nu:g}", SOURCE, partial(cylinder, nu)) for nu in POISSON_RATIOS)


def closed_form(poisson_ratio: float) -> tuple[float, float, float]:
    """Hoop stress at the inner face in Pa, displacement of the inner and of the outer face in m."""
    a2, b2 = INNER**2, OUTER**2
    share = PRESSURE * a2 / (b2 - a2)
    inner, outer = (
        (1.0 + poisson_ratio) * share * ((1.0 - 2.0 * poisson_ratio) * r + b2 / r) / YOUNGS_MODULUS
        for r in (INNER, OUTER)
    )
    return share * (1.0 + b2 / a2), inner, outer


def cylinder(poisson_ratio: float) -> tuple[Quantity, ...]:
    """Hoop stress and radial displacements of a slice held between smooth plates."""
    lines = np.geomspace(INNER, OUTER, ELEMENTS + 1)
    mesh = mapped_mesh(lines, np.array([0.0, HEIGHT]), lambda r, z: (r, z))
    r = mesh.nodes[:, 0]
    body = Body(
        mesh,
        LinearElastic(YOUNGS_MODULUS, poisson_ratio),
        np.stack((np.zeros_like(mesh.top), mesh.top | mesh.base)),
        free_of_ties(mesh),
    )
    inside = np.asarray(r == r.min())
    y = body.solve_linear(body.traction(inside, np.array([PRESSURE, 0.0])))
    u, unknowns = body.numbering.expand(y)[0], body.numbering.count
    hoop, at_inner, at_outer = closed_form(poisson_ratio)
    stress = float(body.corner_stress(y, (INNER, 0.0))[2])
    found = (float(u[inside].mean()), float(u[mesh.border].mean()))
    return (
        Quantity("hoop_inner", 1e-6 * hoop, 1e-6 * stress, "MPa", ALLOWED_PERCENT, unknowns),
        Quantity("u_inner", 1e3 * at_inner, 1e3 * found[0], "mm", ALLOWED_PERCENT, unknowns),
        Quantity("u_outer", 1e3 * at_outer, 1e3 * found[1], "mm", ALLOWED_PERCENT, unknowns),
    )
