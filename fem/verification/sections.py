"""Sections that are no layered specimen: a thick cylinder, Cook's membrane and the elliptic membrane of NAFEMS.

Cylinder under internal pressure in plane strain (Lame; Timoshenko and Goodier, Theory of Elasticity, chapter 4):
sigma_t(r) = p a^2 (1 + b^2 / r^2) / (b^2 - a^2), u(r) = (1 + nu) p a^2 ((1 - 2 nu) r + b^2 / r) / (E (b^2 - a^2)).

Cook's tapered panel is clamped on its long side and sheared on its short one. Corners (0, 0), (48, 44), (48, 60),
(0, 44) mm. Three versions with published answers: plane strain with E = 70 MPa, nu = 1/3 and a shear of 6.25 MPa (upper
right corner), plane stress with E = 1, nu = 1/3 and a force of 1 (corner and middle of the right side), and nearly
incompressible neo-Hookean in plane strain at large strain with mu = 80.194 MPa, K = 400889.8 MPa and 100 N per mm of
thickness (corner).

NAFEMS LE1: a quarter of an elliptic membrane in plane stress, pulled on its outer edge. Inner ellipse with half axes 2
and 1 m, outer one 3.25 and 2.75 m, E = 210 GPa, nu = 0.3, 10 MPa outwards on the outer edge. The tangential stress
where the inner edge meets the long axis is 92.7 MPa (The Standard NAFEMS Benchmarks, 1990).
"""

from __future__ import annotations

from functools import partial

import numpy as np

from fem.arrays import FloatArray
from fem.materials import LinearElastic, Material, NeoHookean
from fem.verification.body import RING, Body, free_of_ties, mapped_mesh, plane_stress_material
from fem.verification.case import Case, Quantity

WIDTH, LEFT, RISE, RIGHT = 48e-3, 44e-3, 44e-3, 16e-3
COOK_RADIUS = RING * WIDTH
LINEAR_REFERENCE, LINEAR_SHEAR, LINEAR_PERCENT = 32.27e-3, 6.25e6, 0.2
FINITE_REFERENCE, FINITE_SHEAR, FINITE_PERCENT = 6.93e-3, 100.0 / RIGHT * 1e3, 100.0 * 0.05 / 6.93
SHEAR_MODULUS, BULK_MODULUS = 80.194e6, 400889.8e6
STRESS_CORNER, STRESS_MIDDLE, STRESS_PERCENT = 25.164, 23.965, 0.2
COOK_SOURCE = "Cook's membrane (J. Struct. Div. ASCE 100 (1974) 1851), converged value of later literature"
ELEMENTS = 24
LE1_INNER, LE1_OUTER = np.array([2.0, 1.0]), np.array([3.25, 2.75])
LE1_YOUNGS_MODULUS, LE1_POISSON_RATIO, TENSION = 210e9, 0.3, 10e6
LE1_REFERENCE, LE1_ALLOWED_PERCENT = 92.7, 0.1
LE1_SOURCE = "The Standard NAFEMS Benchmarks (1990), LE1"
ACROSS, AROUND, GROWTH = 20, 40, 6.0
ON_EDGE = 0.995  # of the outer ellipse's equation: chords lie above it, the next nodes inwards below
CYLINDER_INNER, CYLINDER_OUTER, CYLINDER_HEIGHT, CYLINDER_PRESSURE, CYLINDER_YOUNGS_MODULUS = (
    0.05,
    0.1,
    0.01,
    10e6,
    210e9,
)
CYLINDER_POISSON_RATIOS = (0.3, 0.499)
CYLINDER_ALLOWED_PERCENT = 0.1
CYLINDER_SOURCE = "Lame (Timoshenko and Goodier, Theory of Elasticity, chapter 4)"


def cook_cases() -> tuple[Case, ...]:
    """The three panels."""
    return (
        Case("cook/plane_strain", COOK_SOURCE, linear),
        Case("cook/plane_stress", COOK_SOURCE, plane_stress),
        Case("cook/nearly_incompressible", f"{COOK_SOURCE}, 6.93 +- 0.05 mm", nearly_incompressible),
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


def panel(material: Material, shear: float) -> tuple[Body, FloatArray]:
    """The panel and the load of a shear traction in Pa on its right side."""

    def place(s: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        return COOK_RADIUS + WIDTH * s, RISE * s + t * (LEFT + (RIGHT - LEFT) * s)

    line = np.linspace(0.0, 1.0, ELEMENTS + 1)
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


def le1_cases() -> tuple[Case, ...]:
    """The one case."""
    return (Case("nafems_le1", LE1_SOURCE, membrane),)


def membrane() -> tuple[Quantity, ...]:
    """Tangential stress at the end of the inner long axis."""
    across = (np.geomspace(1.0, GROWTH, ACROSS + 1) - 1.0) / (GROWTH - 1.0)
    mesh = mapped_mesh(across, np.linspace(0.0, 1.0, AROUND + 1), _place)
    x, y = mesh.nodes[:, 0] - RING, mesh.nodes[:, 1] - mesh.nodes[:, 1].min()
    outer = (x / LE1_OUTER[0]) ** 2 + (y / LE1_OUTER[1]) ** 2 > ON_EDGE
    body = Body(
        mesh,
        plane_stress_material(LE1_YOUNGS_MODULUS, LE1_POISSON_RATIO),
        np.stack((np.asarray(x == 0.0), mesh.base)),
        free_of_ties(mesh),
    )
    moved = body.solve_linear(body.pull(outer, TENSION))
    stress = body.corner_stress(moved, (RING + LE1_INNER[0], float(mesh.nodes[:, 1].min())))
    return (Quantity("", LE1_REFERENCE, 1e-6 * float(stress[4]), "MPa", LE1_ALLOWED_PERCENT, body.numbering.count),)


def _place(across: FloatArray, around: FloatArray) -> tuple[FloatArray, FloatArray]:
    angle, axes = 0.5 * np.pi * around, LE1_INNER[:, None] + across * (LE1_OUTER - LE1_INNER)[:, None]
    return RING + axes[0] * np.cos(angle), axes[1] * np.sin(angle)


def cylinder_cases() -> tuple[Case, ...]:
    """One for each Poisson's ratio."""
    return tuple(
        Case(f"lame_cylinder/nu_{nu:g}", CYLINDER_SOURCE, partial(cylinder, nu)) for nu in CYLINDER_POISSON_RATIOS
    )


def closed_form(poisson_ratio: float) -> tuple[float, float, float]:
    """Hoop stress at the inner face in Pa, displacement of the inner and of the outer face in m."""
    a2, b2 = CYLINDER_INNER**2, CYLINDER_OUTER**2
    share = CYLINDER_PRESSURE * a2 / (b2 - a2)
    inner, outer = (
        (1.0 + poisson_ratio) * share * ((1.0 - 2.0 * poisson_ratio) * r + b2 / r) / CYLINDER_YOUNGS_MODULUS
        for r in (CYLINDER_INNER, CYLINDER_OUTER)
    )
    return share * (1.0 + b2 / a2), inner, outer


def cylinder(poisson_ratio: float) -> tuple[Quantity, ...]:
    """Hoop stress and radial displacements of a slice held between smooth plates."""
    lines = np.geomspace(CYLINDER_INNER, CYLINDER_OUTER, ELEMENTS + 1)
    mesh = mapped_mesh(lines, np.array([0.0, CYLINDER_HEIGHT]), lambda r, z: (r, z))
    r = mesh.nodes[:, 0]
    body = Body(
        mesh,
        LinearElastic(CYLINDER_YOUNGS_MODULUS, poisson_ratio),
        np.stack((np.zeros_like(mesh.top), mesh.top | mesh.base)),
        free_of_ties(mesh),
    )
    inside = np.asarray(r == r.min())
    y = body.solve_linear(body.traction(inside, np.array([CYLINDER_PRESSURE, 0.0])))
    u, unknowns = body.numbering.expand(y)[0], body.numbering.count
    hoop, at_inner, at_outer = closed_form(poisson_ratio)
    stress = float(body.corner_stress(y, (CYLINDER_INNER, 0.0))[2])
    found = (float(u[inside].mean()), float(u[mesh.border].mean()))
    return (
        Quantity("hoop_inner", 1e-6 * hoop, 1e-6 * stress, "MPa", CYLINDER_ALLOWED_PERCENT, unknowns),
        Quantity("u_inner", 1e3 * at_inner, 1e3 * found[0], "mm", CYLINDER_ALLOWED_PERCENT, unknowns),
        Quantity("u_outer", 1e3 * at_outer, 1e3 * found[1], "mm", CYLINDER_ALLOWED_PERCENT, unknowns),
    )
