"""Cook's membrane: a tapered panel, clamped on its long side, sheared on its short one.

Corners (0, 0), (48, 44), (48, 60), (0, 44) mm. Three versions with published answers: plane strain with E = 70 MPa,
nu = 1/3 and a shear of 6.25 MPa (upper right corner), plane stress with E = 1, nu = 1/3 and a force of 1 (corner and
middle of the right side), and nearly incompressible neo-Hookean in plane strain at large strain with mu = 80.194 MPa,
K = 400889.8 MPa and 100 N per mm of thickness (corner).
"""

from __future__ import annotations

import numpy as np

from fem.arrays import FloatArray
from fem.materials import LinearElastic, Material, NeoHookean
from fem.verification.body import Body, free_of_ties
from fem.verification.case import Case, Quantity
from fem.verification.section import RING, mapped_mesh, plane_stress_material

WIDTH, LEFT, RISE, RIGHT = 48e-3, 44e-3, 44e-3, 16e-3
RADIUS = RING * WIDTH
LINEAR_REFERENCE, LINEAR_SHEAR, LINEAR_PERCENT = 32.27e-3, 6.25e6, 0.2
FINITE_REFERENCE, FINITE_SHEAR, FINITE_PERCENT = 6.93e-3, 100.0 / RIGHT * 1e3, 100.0 * 0.05 / 6.93
SHEAR_MODULUS, BULK_MODULUS = 80.194e6, 400889.8e6
STRESS_CORNER, STRESS_MIDDLE, STRESS_PERCENT = 25.164, 23.965, 0.2
SOURCE = "Cook's membrane (J. Struct. Div. ASCE 100 (1974) 1851), converged value of later literature"
ELEMENTS = 24


def cases() -> tuple[Case, ...]:
    """The three panels."""
    return (
        Case("cook/plane_strain", SOURCE, linear),
        Case("cook/plane_stress", SOURCE, plane_stress),
        Case("cook/nearly_incompressible", f"{SOURCE}, 6.93 +- 0.05 mm", nearly_incompressible),
    )


def linear() -> tuple[Quantity, ...]:
    """Small strain."""
    body, load = panel(LinearElastic(70e6, 1.0 / 3.0), LINEAR_SHEAR)
    found = corner(body, body.solve_linear(load))
    return (Quantity("", 1e3 * LINEAR_REFERENCE, 1e3 * found, "mm", LINEAR_PERCENT, body.numbering.count),)


def plane_stress() -> tuple[Quantity, ...]:
    """Small strain in plane stress; lengths are in units of 1 mm, so that the force of 1 spreads over 16."""
    body, load = panel(plane_stress_material(1.0, 1.0 / 3.0), 1e-3 / RIGHT)
    y = body.solve_linear(load)
    unknowns = body.numbering.count
    return (
        Quantity("corner", STRESS_CORNER, 1e3 * corner(body, y), "", STRESS_PERCENT, unknowns),
        Quantity("middle", STRESS_MIDDLE, 1e3 * middle(body, y), "", STRESS_PERCENT, unknowns),
    )


def nearly_incompressible() -> tuple[Quantity, ...]:
    """Large strain."""
    youngs = 9.0 * BULK_MODULUS * SHEAR_MODULUS / (3.0 * BULK_MODULUS + SHEAR_MODULUS)
    nu = (3.0 * BULK_MODULUS - 2.0 * SHEAR_MODULUS) / (2.0 * (3.0 * BULK_MODULUS + SHEAR_MODULUS))
    body, load = panel(NeoHookean(youngs, nu), FINITE_SHEAR)
    found = corner(body, body.solve_finite(load, 4))
    return (Quantity("", 1e3 * FINITE_REFERENCE, 1e3 * found, "mm", FINITE_PERCENT, body.numbering.count),)


def panel(material: Material, shear: float, elements: int = ELEMENTS) -> tuple[Body, FloatArray]:
    """The panel and the load of a shear traction in Pa on its right side."""

    def place(s: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        return RADIUS + WIDTH * s, RISE * s + t * (LEFT + (RIGHT - LEFT) * s)

    line = np.linspace(0.0, 1.0, elements + 1)
    mesh = mapped_mesh(line, line, place)
    clamped = mesh.nodes[:, 0] == mesh.nodes[:, 0].min()
    body = Body(mesh, material, np.stack((clamped, clamped)), free_of_ties(mesh))
    return body, body.traction(mesh.border, np.array([0.0, shear]))


def corner(body: Body, y: FloatArray) -> float:
    """Vertical displacement in m of the upper right corner."""
    return float(body.numbering.expand(y)[1][body.mesh.top][0])


def middle(body: Body, y: FloatArray) -> float:
    """Vertical displacement in m of the middle of the right side."""
    right = np.flatnonzero(body.mesh.border)
    at = np.argmin(np.abs(body.mesh.nodes[right, 1] + 0.5 * RIGHT))
    return float(body.numbering.expand(y)[1][right[at]])
