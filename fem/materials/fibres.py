"""Fibre families in an isotropic ground substance, with dispersion, in the plane of a layer.

Each family adds W = k1 / (2 k2) (exp(k2 <E>^2) - 1), E = kappa (I1' - 3) + (1 - 3 kappa) (I4' - 1), I' isochoric,
<E> = E where positive and 0 elsewhere: fibres bear no compression (T. C. Gasser, R. W. Ogden and G. A. Holzapfel,
J. R. Soc. Interface 3 (2006) 15; without dispersion G. A. Holzapfel, T. C. Gasser and R. W. Ogden, J. Elasticity 61
(2000) 1).

With the structure tensor H = kappa I + (1 - 3 kappa) M, E = J^(-2/3) H : C - 1. M is a x a for one direction and
(I - n x n) / 2 for directions spread evenly over the plane (n its normal), which keeps axial symmetry. At rest
E = 0 and the fibres add no stiffness: the moduli at rest are the ground substance's.

Directions must fit the symmetry of the geometry: axial symmetry has none in the plane, a block has mirror planes along
x and y.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.errors import FemError, require_finite, require_positive
from fem.materials.deformation import Deformation
from fem.materials.invariants import structure_change, structure_curvature, structure_gradient
from fem.materials.material import IsochoricLaw, Material

ISOTROPIC = 1.0 / 3.0  # dispersion that spreads the fibres over all directions of space
LARGEST_POWER = 100.0  # k2 E^2 beyond which the law has no answer
PER_FAMILY = 6  # parameters of one family: k1, k2, H_xx, H_yy, H_zz, H_xy
SAME = 1e-9


@dataclass(frozen=True)
class Fibre:
    """One family.

    Attributes
    ----------
    k1
        Stiffness in Pa, above 0.
    k2
        Stiffening, above 0.
    dispersion
        kappa from 0 (aligned) to 1/3 (all directions of space alike).
    angle
        Direction in rad from the x axis in the plane of the layer, in three dimensions only; None: spread evenly
        over the plane.

    Raises
    ------
    FemError
        If a constant is outside its range.
    """

    k1: float
    k2: float
    dispersion: float = 0.0
    angle: float | None = None

    def __post_init__(self) -> None:
        require_positive("fibre: k1", self.k1, "Pa")
        require_positive("fibre: k2", self.k2, "(no unit)")
        if not 0.0 <= self.dispersion <= ISOTROPIC * (1.0 + 1e-12):
            raise FemError(f"fibre: dispersion = {self.dispersion:g}: must be from 0 (aligned) to 1/3 (isotropic)")
        if self.angle is not None:
            require_finite("fibre: angle", self.angle, "rad")

    @property
    def directed(self) -> bool:
        """Whether one direction of the plane differs from the others."""
        return self.angle is not None and self.dispersion < ISOTROPIC * (1.0 - 1e-9)

    @property
    def structure(self) -> tuple[float, float, float, float]:
        """H_xx, H_yy, H_zz and H_xy, z the normal of the layer; the trace is 1."""
        spread = 1.0 - 3.0 * self.dispersion
        c, s = (math.cos(self.angle), math.sin(self.angle)) if self.angle is not None else (0.0, 0.0)
        xx, yy = (c * c, s * s) if self.angle is not None else (0.5, 0.5)
        kappa = self.dispersion
        return kappa + spread * xx, kappa + spread * yy, kappa, spread * c * s


@dataclass(frozen=True)
class FibreLaw:
    """A ground law plus fibres; parameters are the ground law's, then six for each family.

    Attributes
    ----------
    ground
        Law of the ground substance.
    families
        How many families there are.
    """

    ground: IsochoricLaw
    families: int

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Isochoric strain energy in J/m3, (*points)."""
        ground, families = self._parts(parameters)
        out = self.ground.energy(deformation, ground)
        for k1, k2, *structure in families:
            strain = _strain(deformation, _tensor(deformation, structure))
            out = out + 0.5 * k1 / k2 * np.expm1(k2 * strain * strain)
        return out

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """First Piola-Kirchhoff stress in Pa, (components, *points)."""
        ground, families = self._parts(parameters)
        out = self.ground.stress(deformation, ground)
        for k1, k2, *structure in families:
            tensor = _tensor(deformation, structure)
            slope = _slopes(_strain(deformation, tensor), k1, k2)[0]
            out += slope * structure_gradient(deformation, tensor)
        return out

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF, packed upper triangle (pairs, *points), in Pa."""
        ground, families = self._parts(parameters)
        out = self.ground.tangent(deformation, ground)
        for k1, k2, *structure in families:
            tensor = _tensor(deformation, structure)
            slope, bend = _slopes(_strain(deformation, tensor), k1, k2)
            gradient = structure_gradient(deformation, tensor)
            out += structure_curvature(deformation, tensor, slope)
            deformation.components.add_products(out, bend * gradient, gradient)
        return out

    def _parts(self, parameters: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
        first = len(parameters) - PER_FAMILY * self.families
        return parameters[:first], [parameters[n : n + PER_FAMILY] for n in range(first, len(parameters), PER_FAMILY)]


@dataclass(frozen=True)
class FibreReinforced:
    """A hyperelastic solid with fibres.

    Attributes
    ----------
    ground
        The ground substance, which sets the moduli at rest.
    fibres
        The families, at least one.

    Raises
    ------
    FemError
        If there is no family, or the ground is not hyperelastic.
    """

    ground: Material
    fibres: tuple[Fibre, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "fibres", tuple(self.fibres))
        if not self.fibres:
            raise FemError("fibres: none given, at least one family is needed")
        if not self.ground.finite_strain:
            raise FemError(f"fibres: the ground substance {type(self.ground).__name__} must be hyperelastic")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest in Pa: the ground substance's."""
        return self.ground.shear_modulus

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus in Pa: the ground substance's."""
        return self.ground.bulk_modulus

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law."""
        return FibreLaw(self.ground.law, len(self.fibres))

    @property
    def parameters(self) -> tuple[float, ...]:
        """The ground's parameters, then k1, k2 and the structure tensor of each family."""
        families = [value for fibre in self.fibres for value in (fibre.k1, fibre.k2, *fibre.structure)]
        return (*self.ground.parameters, *families)

    @property
    def finite_strain(self) -> bool:
        """Objective: valid in finite kinematics."""
        return True


def _tensor(d: Deformation, structure: list[FloatArray]) -> FloatArray:
    """H (components, *broadcast), to be multiplied with arrays (components, *points)."""
    xx, yy, zz, xy = structure
    entry = {(0, 0): xx, (1, 1): yy, (2, 2): zz, (0, 1): xy, (1, 0): xy}
    table = np.stack([entry.get(position, np.zeros_like(xx)) for position in d.components.positions])
    return table.reshape(len(table), *(1,) * (d.J.ndim - table.ndim + 1), *table.shape[1:])


def _strain(d: Deformation, tensor: FloatArray) -> FloatArray:
    """<E>, (*points)."""
    return np.maximum(structure_change(d, tensor), 0.0)


def _slopes(strain: FloatArray, k1: FloatArray, k2: FloatArray) -> tuple[FloatArray, FloatArray]:
    """2 dW/dE and 4 d2W/dE2 in Pa, zero where the fibres are not stretched, NaN where they would be torn."""
    power = k2 * strain * strain
    growth = k1 * np.exp(np.where(power < LARGEST_POWER, power, np.nan))
    return 2.0 * growth * strain, np.where(strain > 0.0, 4.0 * growth * (1.0 + 2.0 * k2 * strain * strain), 0.0)


def require_fibre_symmetry(materials: Mapping[str, Material], geometry: str) -> None:
    """Refuse directions of fibres in a layer's material that the geometry cannot have.

    Axial symmetry has no direction in the plane; a block has mirror planes along x and y.

    Raises
    ------
    FemError
        If a family breaks the symmetry.
    """
    for name, material in materials.items():
        if not isinstance(material, FibreReinforced):
            continue
        directed = [fibre for fibre in material.fibres if fibre.directed]
        if geometry == "axisymmetric" and directed:
            raise FemError(
                f"layer {name!r}: fibre angle = {_degrees(directed[0]):g} deg breaks the symmetry of geometry = "
                "'axisymmetric': leave the angle out (fibres spread evenly over the plane), set dispersion = 1/3, "
                "or use a geometry in three dimensions"
            )
        lonely = [fibre for fibre in directed if geometry == "block" and not _mirrored(fibre, directed)]
        if lonely:
            raise FemError(
                f"layer {name!r}: fibre angle = {_degrees(lonely[0]):g} deg breaks the mirror planes of "
                "geometry = 'block': use 0 or 90 deg, two equal families at plus and minus the angle, or 'surface'"
            )


def _mirrored(fibre: Fibre, families: list[Fibre]) -> bool:
    """Whether the mirror image of a family is there, and as often as the family itself."""
    alike = [f for f in families if (f.k1, f.k2, f.dispersion) == (fibre.k1, fibre.k2, fibre.dispersion)]
    angle = fibre.angle or 0.0
    here = sum(_apart(f.angle or 0.0, angle) < SAME for f in alike)
    return here == sum(_apart(f.angle or 0.0, -angle) < SAME for f in alike)


def _apart(first: float, second: float) -> float:
    """Angle between two directions without sense, in rad."""
    return abs(math.remainder(first - second, math.pi))


def _degrees(fibre: Fibre) -> float:
    return math.degrees(fibre.angle or 0.0)
