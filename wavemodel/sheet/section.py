"""The cross-section of a layered sheet: where its neutral plane lies and how stiff it is (z downwards from there)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.specimen import WaveLayer

POINTS_PER_LAYER = 4


@dataclass(frozen=True)
class SheetSection:
    """L layers with s quadrature points through their thickness.

    Attributes
    ----------
    faces
        (L + 1,) distance of the faces below the neutral plane, m, from the upper (negative) to the lower one.
    z, weight
        (s,) points below the neutral plane and their weights, m.
    shear_modulus, lame_modulus
        (s,) at the points, Pa.
    membrane, bending, shear
        Plate moduli: E h / (1 - nu^2) in N/m, D in N m, and the transverse shear stiffness (5/6 G h for one layer)
        in N/m.
    mass
        Per area, kg/m2.
    rotary_inertia
        Per area, kg.
    """

    faces: FloatArray
    z: FloatArray
    weight: FloatArray
    shear_modulus: FloatArray
    lame_modulus: FloatArray
    membrane: float
    bending: float
    shear: float
    mass: float
    rotary_inertia: float

    @property
    def thickness(self) -> float:
        """Of the sheet, m."""
        return float(self.faces[-1] - self.faces[0])

    @cached_property
    def thinning(self) -> float:
        """Exponent m of the thickness stretch (l1 l2)^-m under tension: nu / (1 - nu), averaged."""
        share = self.lame_modulus / (self.lame_modulus + 2.0 * self.shear_modulus)
        return float(share @ self.weight / self.weight.sum())

    @cached_property
    def poisson_ratio(self) -> float:
        """Of the membrane, averaged by plane modulus."""
        modulus = _plane_modulus(self.shear_modulus, self.lame_modulus)
        poisson = 0.5 * self.lame_modulus / (self.lame_modulus + self.shear_modulus)
        return float((modulus * poisson) @ self.weight / (modulus @ self.weight))


def section(layers: Sequence[WaveLayer]) -> SheetSection:
    """Homogenise a stack of layers.

    Raises
    ------
    WaveError
        If there is no layer.
    """
    if not layers:
        raise WaveError("layers: none given, at least one is needed")
    thickness = np.array([layer.thickness for layer in layers])
    top = np.concatenate([[0.0], np.cumsum(thickness)])
    point, share = np.polynomial.legendre.leggauss(POINTS_PER_LAYER)
    depth = (top[:-1, None] + 0.5 * thickness[:, None] * (point + 1.0)).ravel()
    weight = (0.5 * thickness[:, None] * share).ravel()
    shear, lame, density = (
        np.repeat([getattr(layer, name) for layer in layers], POINTS_PER_LAYER)
        for name in ("shear_modulus", "lame_modulus", "density")
    )
    modulus = _plane_modulus(shear, lame)
    neutral = float((modulus * depth) @ weight / (modulus @ weight))
    z = depth - neutral
    bending = float((modulus * z**2) @ weight)
    return SheetSection(
        faces=top - neutral,
        z=z,
        weight=weight,
        shear_modulus=shear,
        lame_modulus=lame,
        membrane=float(modulus @ weight),
        bending=bending,
        shear=_shear_stiffness(layers, top - neutral, bending),
        mass=float(density @ weight),
        rotary_inertia=float((density * z**2) @ weight),
    )


def _plane_modulus(shear: FloatArray, lame: FloatArray) -> FloatArray:
    """E / (1 - nu^2)."""
    return np.asarray(4.0 * shear * (lame + shear) / (lame + 2.0 * shear))


def _shear_stiffness(layers: Sequence[WaveLayer], faces: FloatArray, bending: float) -> float:
    """Q^2 / int tau^2 / G dz, with the shear stress tau that balances the bending stress (Jourawski).

    tau(z) = Q / D int_top^z modulus s ds is quadratic in each layer; its square over G is integrated exactly.
    """
    point, share = np.polynomial.legendre.leggauss(POINTS_PER_LAYER)
    carried, energy = 0.0, 0.0
    for layer, upper, lower in zip(layers, faces[:-1], faces[1:], strict=True):
        modulus = layer.youngs_modulus / (1.0 - layer.poisson_ratio**2)
        z = upper + 0.5 * (lower - upper) * (point + 1.0)
        stress = carried + 0.5 * modulus * (z**2 - upper**2)
        energy += float(stress**2 @ share) * 0.5 * (lower - upper) / layer.shear_modulus
        carried += 0.5 * modulus * float(lower**2 - upper**2)
    return bending**2 / energy
