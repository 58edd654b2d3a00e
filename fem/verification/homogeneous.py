"""Hyperelastic bodies in homogeneous deformation, on distorted meshes: exact whatever the mesh.

Neo-Hookean, W = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2: with principal stretches l_i the principal nominal stresses are
P_i = mu J^(-2/3) (l_i - I1 / (3 l_i)) + K (J - 1) J / l_i (Bonet and Wood, chapter 6).
Simple shear F = I + g e_z x e_x: J = 1, I1 = 3 + g^2, P = mu (F - I1/3 F^-T).

Each other law in a uniaxial stretch: with L_a = J^(-1/3) l_a and b_a = L_a dw/dL_a the principal nominal stresses are
P_a = (b_a - mean b) / l_a + K (J - 1) J / l_a (Ogden, Non-linear Elastic Deformations, 1984, chapter 7). The sources of
the laws stand in :mod:`fem.materials`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal, TypeAlias

import numpy as np
from scipy.optimize import brentq

from fem.analysis.newton import NewtonSettings
from fem.analysis.stepping import Stepper
from fem.arrays import FloatArray
from fem.materials import Fibre, FibreReinforced, Gent, Material, MooneyRivlin, NeoHookean, Ogden, Yeoh
from fem.verification.body import PLANE_PERCENT, RING, Body, distorted_square, free_of_ties, worst
from fem.verification.case import Case, Quantity

YOUNGS_MODULUS = 6e4
POISSON_RATIOS = (0.45, 0.4999)
STRETCHES = (0.5, 1.5)
EQUIBIAXIAL = (0.8, 1.4)
SHEARS = (0.5, 1.5)
ALLOWED_PERCENT = 1e-6
SOURCE = "neo-Hookean closed form (Bonet and Wood, 2nd ed., chapter 6)"
COUNT, SEED = 3, 20
SHEAR_STEPS = 12
FEBIO_SOURCE = "FEBio's test suite, te01.feb, and the gold standard of its Linux build (FEBio 3)"
FEBIO_UNIT, FEBIO_LENGTH, FEBIO_PERCENT = 1e4, 0.44268188785, 1e-4
"""Pa for the suite's unit of stress; the suite's length; what the two volumetric energies may part by."""
LAW_POISSON_RATIOS, LAW_STRETCHES = (0.45, 0.4999), (0.7, 1.4)
LAW_SOURCE = "closed form in principal stretches (Ogden 1984, chapter 7)"
C10, C01, C20, C30, MU, JM = 1.2e4, 5e3, -2e3, 1.5e3, 3e4, 20.0
TERMS = ((1.2e4, 2.7), (-5e3, -3.0))
FIBRE = Fibre(2e4, 1.5, 0.1)


def cases() -> tuple[Case, ...]:
    """Uniaxial stretch, equibiaxial stretch and simple shear at two Poisson's ratios."""
    kinds = (("uniaxial", uniaxial, STRETCHES), ("equibiaxial", equibiaxial, EQUIBIAXIAL), ("shear", shear, SHEARS))
    return tuple(
        Case(f"neo_hookean_{name}/nu_{nu:g}/{amount:g}", SOURCE, partial(function, nu, amount))
        for name, function, amounts in kinds
        for nu in POISSON_RATIOS
        for amount in amounts
    )


def principal_stress(material: NeoHookean, radial: float, axial: float) -> tuple[float, float]:
    """Nominal stresses in Pa, radial and axial, of the stretches (radial, radial, axial)."""
    mu, bulk = material.shear_modulus, material.bulk_modulus
    volume, invariant = radial * radial * axial, 2.0 * radial * radial + axial * axial
    isochoric, pressure = mu * volume ** (-2.0 / 3.0), bulk * (volume - 1.0) * volume
    across, along = (isochoric * (x - invariant / (3.0 * x)) + pressure / x for x in (radial, axial))
    return across, along


def uniaxial(poisson_ratio: float, stretch: float, stabilisation: float = 1.0) -> tuple[Quantity, ...]:
    """Cylinder between frictionless plates: axial nominal stress and radial stretch at an axial stretch."""
    material = NeoHookean(YOUNGS_MODULUS, poisson_ratio)
    return pressed(material, partial(principal_stress, material), stretch, stabilisation)


def pressed(
    material: Material,
    principal: Callable[[float, float], tuple[float, float]],
    stretch: float,
    stabilisation: float,
) -> tuple[Quantity, ...]:
    """Axial nominal stress and radial stretch of a cylinder between frictionless plates.

    Parameters
    ----------
    material
        Its material.
    principal
        Nominal stresses in Pa, radial and axial, of a radial and an axial stretch, in closed form.
    stretch
        Axial stretch.
    stabilisation
        See :func:`fem.assembly.elements.make_elements`.
    """
    body, stepper = _between_plates(material, "depth", stabilisation)
    state = stepper.advance(1.0 - stretch).state
    exact = float(brentq(lambda a: principal(a, stretch)[0], 0.2, 5.0, xtol=1e-15))
    unknowns, found = body.numbering.count, 1.0 + body.gradient(state.y)[2]
    stress = principal(exact, stretch)[1]
    return (
        Quantity("nominal_stress", 1e-3 * stress, -1e-3 * state.force / np.pi, "kPa", ALLOWED_PERCENT, unknowns),
        Quantity("lateral_stretch", exact, worst(found, exact), "", ALLOWED_PERCENT, unknowns),
    )


def _between_plates(
    material: Material, control: Literal["force", "depth"], stabilisation: float
) -> tuple[Body, Stepper]:
    """Cylinder of radius and height 1 m between frictionless plates, and what presses it."""
    mesh = distorted_square(COUNT, SEED)
    body = Body(mesh, material, np.stack((mesh.axis, mesh.base)), mesh.top, stabilisation)
    probe = int(body.numbering.unknown[1, mesh.interfaces[0][0]])
    load = np.zeros(body.numbering.count)
    load[probe] = -1.0
    return body, Stepper(body.equilibrium(load, probe), control, 1e-3 * YOUNGS_MODULUS, NewtonSettings())


def equibiaxial(poisson_ratio: float, stretch: float) -> tuple[Quantity, ...]:
    """Disc pulled all round by the closed-form nominal stress: radial and axial stretch."""
    mesh, material = distorted_square(COUNT, SEED), NeoHookean(YOUNGS_MODULUS, poisson_ratio)
    axial = float(brentq(lambda x: principal_stress(material, stretch, x)[1], 0.1, 10.0, xtol=1e-15))
    body = Body(mesh, material, np.stack((mesh.axis, mesh.base)), free_of_ties(mesh), 1.0)
    load = body.traction(mesh.border, np.array([principal_stress(material, stretch, axial)[0], 0.0]))
    H, unknowns = body.gradient(body.solve_finite(load, 4)), body.numbering.count
    return (
        Quantity("stretch", stretch, worst(1.0 + H[2], stretch), "", ALLOWED_PERCENT, unknowns),
        Quantity("thickness_stretch", axial, worst(1.0 + H[4], axial), "", ALLOWED_PERCENT, unknowns),
    )


def shear(poisson_ratio: float, amount: float) -> tuple[Quantity, ...]:
    """Block in plane strain that slides along its border, tractions following the closed form: the shear at the end."""
    mesh, material = distorted_square(COUNT, SEED, RING), NeoHookean(YOUNGS_MODULUS, poisson_ratio)
    left = mesh.nodes[:, 0] == mesh.nodes[:, 0].min()
    around = left | mesh.border | mesh.top | mesh.base
    body = Body(mesh, material, np.stack((around, left)), free_of_ties(mesh), 1.0)
    y = np.zeros(body.numbering.count)
    for part in np.linspace(0.0, amount, SHEAR_STEPS + 1)[1:].tolist():
        stress = _shear_stress(material, part)
        load = body.traction(mesh.border, stress[[0, 3]])
        load += body.traction(mesh.top, stress[[1, 4]]) - body.traction(mesh.base, stress[[1, 4]])
        y = body.solve_from(load, y)
    found = body.gradient(y)[3]
    return (Quantity("", amount, worst(found, amount), "", PLANE_PERCENT, body.numbering.count),)


def _shear_stress(material: NeoHookean, amount: float) -> FloatArray:
    """Nominal stress (rr, rz, tt, zr, zz) in Pa of u_z = amount x."""
    third = 1.0 + amount * amount / 3.0
    return material.shear_modulus * np.array([1.0 - third, third * amount, 1.0 - third, amount, 1.0 - third])


def another_code_cases() -> tuple[Case, ...]:
    """What another code prints of a homogeneous press of its own suite."""
    return (Case("febio/te01", FEBIO_SOURCE, febio_tetrahedron),)


def febio_tetrahedron() -> tuple[Quantity, ...]:
    """Length of the three free displacements of a corner tetrahedron whose nominal axial stress is -3 c1.

    FEBio's own volumetric energy, K/2 (ln J)^2, gives 0.442681893 in closed form and ours 0.442681662: 5e-5 % apart.
    """
    mu, bulk = 2.0 * FEBIO_UNIT, 1000.0 * FEBIO_UNIT
    material = MooneyRivlin(0.5 * mu, 0.0, (1.5 * bulk - mu) / (3.0 * bulk + mu))
    body, stepper = _between_plates(material, "force", 1.0)
    y = stepper.advance(3.0 * FEBIO_UNIT * np.pi).state.y
    slopes = body.gradient(y)
    found = np.sqrt(2.0 * slopes[2] ** 2 + slopes[4] ** 2)
    ours = worst(found, FEBIO_LENGTH)
    return (Quantity("", FEBIO_LENGTH, ours, "", FEBIO_PERCENT, body.numbering.count),)


Slopes: TypeAlias = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class _Law:
    """A law by its material for a Poisson's ratio, and b_a (3,) of the isochoric stretches (3,)."""

    material: Callable[[float], Material]
    slopes: Slopes


def law_cases() -> tuple[Case, ...]:
    """Axial stress and lateral stretch of each law, compressed and stretched, nearly incompressible too."""
    return tuple(
        Case(f"law_{name}/nu_{nu:g}/{stretch:g}", LAW_SOURCE, partial(uniaxial_of_law, name, nu, stretch))
        for name in LAWS
        for nu in LAW_POISSON_RATIOS
        for stretch in LAW_STRETCHES
    )


def uniaxial_of_law(name: str, poisson_ratio: float, stretch: float) -> tuple[Quantity, ...]:
    """Cylinder between frictionless plates."""
    law = LAWS[name]
    material = law.material(poisson_ratio)

    def principal(radial: float, axial: float) -> tuple[float, float]:
        stretches, volume = np.array([radial, radial, axial]), radial * radial * axial
        b = law.slopes(stretches * volume ** (-1.0 / 3.0))
        nominal = (b - b.mean() + material.bulk_modulus * (volume - 1.0) * volume) / stretches
        return float(nominal[0]), float(nominal[2])

    return pressed(material, principal, stretch, 1.0)


def _mooney_rivlin(L: FloatArray) -> FloatArray:
    return np.asarray(2.0 * C10 * L**2 - 2.0 * C01 / L**2)


def _yeoh(L: FloatArray) -> FloatArray:
    x = float((L**2).sum()) - 3.0
    return np.asarray(2.0 * (C10 + 2.0 * C20 * x + 3.0 * C30 * x * x) * L**2)


def _ogden(L: FloatArray) -> FloatArray:
    return np.asarray(sum(mu * L**alpha for mu, alpha in TERMS))


def _gent(L: FloatArray) -> FloatArray:
    return np.asarray(MU * JM / (JM + 3.0 - float((L**2).sum())) * L**2)


def _fibres(L: FloatArray) -> FloatArray:
    """Neo-Hookean ground and fibres spread over the plane across the axis."""
    kappa = FIBRE.dispersion
    share = kappa + (1.0 - 3.0 * kappa) * np.array([0.5, 0.5, 0.0])
    strain = max(float(share @ L**2) - 1.0, 0.0)
    slope = FIBRE.k1 * strain * float(np.exp(FIBRE.k2 * strain**2))
    return np.asarray((MU + 2.0 * slope * share) * L**2)


def _ground(poisson_ratio: float) -> NeoHookean:
    return NeoHookean(2.0 * MU * (1.0 + poisson_ratio), poisson_ratio)


LAWS = {
    "mooney_rivlin": _Law(lambda nu: MooneyRivlin(C10, C01, nu), _mooney_rivlin),
    "yeoh": _Law(lambda nu: Yeoh(C10, C20, C30, nu), _yeoh),
    "ogden": _Law(lambda nu: Ogden(TERMS, nu), _ogden),
    "gent": _Law(lambda nu: Gent(MU, JM, nu), _gent),
    "planar_fibres": _Law(lambda nu: FibreReinforced(_ground(nu), (FIBRE,)), _fibres),
}
