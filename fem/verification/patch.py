"""Patch tests: a uniform strain on a distorted mesh, loaded by its tractions on the border, must come out exactly.

Small strain, sigma = 2 mu eps + lambda tr(eps) I (Hooke). Round: u_r = e_r r, u_z = e_z z. Plane: a ring far from the
axis with u_r = e x, u_z = g x + e_z z.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from fem.arrays import FloatArray
from fem.materials import LinearElastic
from fem.verification.body import PLANE_PERCENT, RING, Body, distorted_square, free_of_ties, worst
from fem.verification.case import Case, Quantity

YOUNGS_MODULUS = 1e5
POISSON_RATIOS = (0.3, 0.4999)
RADIAL, AXIAL, SHEAR = 1e-3, -2.3e-3, 1.7e-3
ALLOWED_PERCENT = 1e-6
SOURCE = "uniform strain, Hooke's law (patch test of Irons)"
COUNT, SEED = 4, 7


def cases() -> tuple[Case, ...]:
    """A round and a plane patch at two Poisson's ratios."""
    return tuple(
        Case(f"patch_{name}/nu_{nu:g}", SOURCE, partial(function, nu))
        for name, function in (("axisymmetric", axisymmetric), ("plane_strain", plane_strain))
        for nu in POISSON_RATIOS
    )


def axisymmetric(poisson_ratio: float) -> tuple[Quantity, ...]:
    """Cylinder under radial and axial tractions: the strains."""
    mesh, material = distorted_square(COUNT, SEED), LinearElastic(YOUNGS_MODULUS, poisson_ratio)
    body = Body(mesh, material, np.stack((mesh.axis, mesh.base)), free_of_ties(mesh))
    stress = _hooke(material, np.array([RADIAL, 0.0, RADIAL, 0.0, AXIAL]))
    load = body.traction(mesh.border, stress[[0, 1]]) + body.traction(mesh.top, stress[[3, 4]])
    H, unknowns = body.gradient(body.solve_linear(load)), body.numbering.count
    return (
        Quantity("radial", RADIAL, worst(H[0], RADIAL), "", ALLOWED_PERCENT, unknowns),
        Quantity("hoop", RADIAL, worst(H[2], RADIAL), "", ALLOWED_PERCENT, unknowns),
        Quantity("axial", AXIAL, worst(H[4], AXIAL), "", ALLOWED_PERCENT, unknowns),
    )


def plane_strain(poisson_ratio: float) -> tuple[Quantity, ...]:
    """Block held without constraint of its strain, under normal and shear tractions: the strains."""
    mesh, material = distorted_square(COUNT, SEED, RING), LinearElastic(YOUNGS_MODULUS, poisson_ratio)
    left = np.asarray(mesh.nodes[:, 0] == mesh.nodes[:, 0].min())
    corner = left & mesh.base
    body = Body(mesh, material, np.stack((left, corner)), free_of_ties(mesh))
    stress = _hooke(material, np.array([RADIAL, 0.5 * SHEAR, 0.0, 0.5 * SHEAR, AXIAL]))
    load = body.traction(mesh.border, stress[[0, 3]]) + body.traction(mesh.top, stress[[1, 4]])
    load = load - body.traction(mesh.base, stress[[1, 4]]) - body.traction(left, stress[[0, 3]])
    H, unknowns = body.gradient(body.solve_linear(load)), body.numbering.count
    return (
        Quantity("normal_x", RADIAL, worst(H[0], RADIAL), "", PLANE_PERCENT, unknowns),
        Quantity("normal_z", AXIAL, worst(H[4], AXIAL), "", PLANE_PERCENT, unknowns),
        Quantity("shear", SHEAR, worst(H[1] + H[3], SHEAR), "", PLANE_PERCENT, unknowns),
    )


def _hooke(material: LinearElastic, strain: FloatArray) -> FloatArray:
    """Stress (rr, rz, tt, zr, zz) in Pa of small strains in the same order."""
    identity = np.array([1.0, 0.0, 1.0, 0.0, 1.0])
    shear = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio))
    lame = 2.0 * shear * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio)
    out: FloatArray = 2.0 * shear * strain + lame * (strain @ identity) * identity
    return out
