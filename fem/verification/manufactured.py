"""Manufactured solutions: the rate of convergence is the test.

The load is the work of the exact stress, int P(u) : grad v, so the discrete solution is the Galerkin projection of
a chosen smooth displacement without change of volume. Q2/P1 must converge with h^3 in the displacement and h^2 in the
gradient (L2 norms), at nu = 0.4999 as at 0.3 (Boffi, Brezzi and Fortin, Mixed Finite Element Methods, chapter 8).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from fem.arrays import FloatArray
from fem.materials import NeoHookean
from fem.materials.components import AXISYMMETRIC
from fem.materials.deformation import Deformation
from fem.mesh.quads import build_mesh
from fem.verification.body import Body, free_of_ties
from fem.verification.case import Case, Quantity

Field: TypeAlias = Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]

POISSON_RATIOS = (0.3, 0.499, 0.4999)
MESHES = (8, 16)
DISPLACEMENT_RATE, GRADIENT_RATE = 3.0, 2.0
ALLOWED_PERCENT = 2.0
SOURCE = "manufactured solution; optimal rate of Q2/P1 (Boffi, Brezzi and Fortin, chapter 8)"


def stream(r: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Solenoidal displacement (2, ...) and its gradient (rr, rz, tt, zr, zz), zero on the base z = -1."""
    b = z + 1.0
    u = np.stack((-r * (1 - r * r) * b * (2 + 3 * b), (2 - 4 * r * r) * b * b * (1 + b)))
    tt = -(1 - r * r) * b * (2 + 3 * b)
    rr, rz = tt + 2 * r * r * b * (2 + 3 * b), -r * (1 - r * r) * (2 + 6 * b)
    return u, np.stack((rr, rz, tt, -8 * r * b * b * (1 + b), (2 - 4 * r * r) * b * (2 + 3 * b)))


def bulge(r: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Large displacement z -> h(z), r -> r h'(z)^(-1/2), h = z - b^3 / 24, b = z + 1; J = 1 everywhere."""
    b = z + 1.0
    slope = 1 - 0.125 * b * b
    wide = slope**-0.5
    u = np.stack((r * (wide - 1), -(b**3) / 24))
    return u, np.stack((wide - 1, 0.125 * r * b * slope**-1.5, wide - 1, 0.0 * r, slope - 1))


FIELDS: Mapping[str, Field] = MappingProxyType({"linear": stream, "finite": bulge})


@dataclass(frozen=True)
class Errors:
    """L2 errors of one mesh and its number of unknowns."""

    displacement: float
    gradient: float
    unknowns: int


def cases() -> tuple[Case, ...]:
    """Small and large strain at each Poisson's ratio."""
    return tuple(
        Case(f"manufactured_{kinematics}/nu_{nu:g}", SOURCE, partial(rates, kinematics, nu))
        for kinematics in FIELDS
        for nu in POISSON_RATIOS
    )


def rates(kinematics: str, poisson_ratio: float) -> tuple[Quantity, ...]:
    """Rates of convergence of displacement and gradient when the elements are halved."""
    coarse, fine = (errors(kinematics, poisson_ratio, count) for count in MESHES)
    of_u, of_gradient = np.log2((coarse.displacement / fine.displacement, coarse.gradient / fine.gradient)).tolist()
    return (
        Quantity("displacement_rate", DISPLACEMENT_RATE, of_u, "", ALLOWED_PERCENT, fine.unknowns),
        Quantity("gradient_rate", GRADIENT_RATE, of_gradient, "", ALLOWED_PERCENT, fine.unknowns),
    )


def errors(kinematics: str, poisson_ratio: float, count: int) -> Errors:
    """Errors on a mesh of count x count elements of the unit cylinder."""
    line = np.linspace(0.0, 1.0, count + 1)
    mesh = build_mesh(line, line, np.zeros(1))
    body = Body(mesh, NeoHookean(1.0, poisson_ratio), np.stack((mesh.base | mesh.axis, mesh.base)), free_of_ties(mesh))
    exact, H = FIELDS[kinematics](*body.points)
    load = body.work_of(_stress(body, H, kinematics))
    finite = kinematics == "finite"
    y = body.solve_from(load, _interpolated(body, kinematics)) if finite else body.solve_linear(load)
    shapes, found = body.geometry.shapes, body.scatter.gather(y)
    value = shapes.radial[-shapes.count :]
    off = np.stack((value @ found[:9], value @ found[9:])) - exact
    slope = body.gradient(y) - H
    norms = [float(np.sqrt(np.sum(e**2 * body.geometry.weight))) for e in (off, slope)]
    return Errors(norms[0], norms[1], body.numbering.count)


def _interpolated(body: Body, kinematics: str) -> FloatArray:
    """Unknowns of the exact displacement at the nodes."""
    nodal, y = FIELDS[kinematics](*body.mesh.nodes.T)[0], np.zeros(body.numbering.count)
    free = body.numbering.unknown >= 0
    y[body.numbering.unknown[free]] = nodal[free]
    return y


def _stress(body: Body, H: FloatArray, kinematics: str) -> FloatArray:
    """Exact nominal stress (5, q, E) of a displacement gradient."""
    d, material = Deformation(AXISYMMETRIC, H), body.material
    if kinematics == "finite":
        law = material.law.stress(d, np.array(material.parameters))
        return law + material.bulk_modulus * d.volume_change * d.cofactor
    stress = 2.0 * material.shear_modulus * d.small_strain
    trace = H[AXISYMMETRIC.normal].sum(axis=0)
    stress[AXISYMMETRIC.normal] += (material.bulk_modulus - 2.0 / 3.0 * material.shear_modulus) * trace
    return stress
