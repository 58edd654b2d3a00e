"""Each hyperelastic law in a homogeneous uniaxial stretch, on a distorted mesh: exact whatever the mesh.

With L_a = J^(-1/3) l_a and b_a = L_a dw/dL_a the principal nominal stresses are
P_a = (b_a - mean b) / l_a + K (J - 1) J / l_a (Ogden, Non-linear Elastic Deformations, 1984, chapter 7). The sources of
the laws stand in :mod:`fem.materials`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np

from fem.arrays import FloatArray
from fem.materials import Fibre, FibreReinforced, Gent, Material, MooneyRivlin, NeoHookean, Ogden, Yeoh
from fem.verification.case import Case, Quantity
from fem.verification.homogeneous import pressed

POISSON_RATIOS, STRETCHES = (0.45, 0.4999), (0.7, 1.4)
SOURCE = "closed form in principal stretches (Ogden 1984, chapter 7)"
C10, C01, C20, C30, MU, JM = 1.2e4, 5e3, -2e3, 1.5e3, 3e4, 20.0
TERMS = ((1.2e4, 2.7), (-5e3, -3.0))
FIBRE = Fibre(2e4, 1.5, 0.1)
Slopes: TypeAlias = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class _Law:
    """A law by its material for a Poisson's ratio, and b_a (3,) of the isochoric stretches (3,)."""

    material: Callable[[float], Material]
    slopes: Slopes


def cases() -> tuple[Case, ...]:
    """Axial stress and lateral stretch of each law, compressed and stretched, nearly incompressible too."""
    return tuple(
        Case(f"law_{name}/nu_{nu:g}/{stretch:g}", SOURCE, partial(uniaxial, name, nu, stretch))
        for name in LAWS
        for nu in POISSON_RATIOS
        for stretch in STRETCHES
    )


def uniaxial(name: str, poisson_ratio: float, stretch: float) -> tuple[Quantity, ...]:
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
