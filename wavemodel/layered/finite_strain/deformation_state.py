"""State of deformation at any points: energy, stress and its change, neo-Hookean or by a layer's own law.

W = mu / 2 (J^(-2/3) tr C - 3) + K / 2 (J - 1)^2 with mu and K from the moduli at rest (J. Bonet and R. D. Wood,
Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., sections 6.5.2 and 6.5.3). Tensors have five
components: rr, rz, zr, zz and the hoop. Where a layer has its own law (`StrainEnergy`), that stands for the first term.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.specimen import StrainEnergy

REST = np.array([1.0, 0.0, 0.0, 1.0, 1.0])
MOST_CRUSHED = 0.05
"""A volume ratio below this is no state to go on from."""


@dataclass(frozen=True)
class LawColumns:
    """A law of the points (..., `columns`).

    Attributes
    ----------
    columns
        Along the last axis of the points.
    law
        Of their layer.
    """

    columns: slice
    law: StrainEnergy


@dataclass(frozen=True)
class LawState:
    """What a law answers to the gradient (5, ...) of its columns.

    Attributes
    ----------
    columns, gradient
        Its points, and there.
    law
        The law.
    energy, stress
        (...) J/m3 and (5, ...) Pa.
    """

    columns: slice
    gradient: FloatArray
    law: StrainEnergy
    energy: FloatArray
    stress: FloatArray

    @cached_property
    def tangent(self) -> FloatArray:
        """(5, 5, ...) Pa."""
        return self.law.tangent(self.gradient)

    def stress_change(self, change: FloatArray) -> FloatArray:
        """(5, ...) to first order."""
        return np.asarray(np.einsum("ij...,j...->i...", self.tangent, change))


@dataclass(frozen=True)
class Deformed:
    """State of deformation at any points (...).

    Attributes
    ----------
    F, H
        (5, ...) deformation gradient and its inverse transposed.
    J, plane
        (...) volume ratio, and determinant in the plane.
    first
        (...) trace of C.
    scale, bulk
        (...) mu J^(-2/3), zero where the layer has its own law, and K, Pa.
    laws
        What those answer.
    """

    F: FloatArray
    H: FloatArray
    J: FloatArray
    plane: FloatArray
    first: FloatArray
    scale: FloatArray
    bulk: FloatArray
    laws: tuple[LawState, ...] = ()

    @property
    def energy(self) -> FloatArray:
        """(...) W in J/m3."""
        shear = 0.5 * self.scale * (self.first - 3.0 * self.J ** (2.0 / 3.0))
        out = np.asarray(shear + 0.5 * self.bulk * (self.J - 1.0) ** 2)
        for own in self.laws:
            out[..., own.columns] += own.energy
        return out

    @property
    def stress(self) -> FloatArray:
        """(5, ...) first Piola-Kirchhoff stress, Pa."""
        out = np.asarray(self.scale * self.F + self._along_inverse * self.H)
        for own in self.laws:
            out[..., own.columns] += own.stress
        return out

    @cached_property
    def _along_inverse(self) -> FloatArray:
        return np.asarray(self.bulk * (self.J - 1.0) * self.J - self.scale * self.first / 3.0)

    @cached_property
    def _by_volume(self) -> tuple[FloatArray, FloatArray]:
        """(...) and (...) Pa, what a change of volume is multiplied by: for the shear, per its modulus, and bulk."""
        return np.asarray(2.0 / 9.0 * self.first), np.asarray(self.bulk * (2.0 * self.J - 1.0) * self.J)

    @cached_property
    def _plane_cofactor(self) -> FloatArray:
        """(4, ...) of F."""
        return _cofactor(self.F)[:4]

    def stress_change(self, change: FloatArray) -> FloatArray:
        """(5, ...) change of stress with a change (5, ...) of F, to first order."""
        volume = np.einsum("i...,i...->...", self.H, change)
        stretch = np.einsum("i...,i...->...", self.F, change)
        shear, bulk = self._by_volume
        along = self.scale * (shear * volume - 2.0 / 3.0 * stretch)
        along += bulk * volume
        out = self.scale * (change - (2.0 / 3.0) * volume * self.F)
        out += along * self.H
        out += self._along_inverse * self._inverse_change(change)
        for own in self.laws:
            out[..., own.columns] += own.stress_change(change[..., own.columns])
        return np.asarray(out)

    def _inverse_change(self, change: FloatArray) -> FloatArray:
        """(5, ...) change of H."""
        turned = _cofactor(change)
        plane = np.einsum("i...,i...->...", self._plane_cofactor, change[:4])
        turned[:4] = (turned[:4] - self.H[:4] * plane) / self.plane
        turned[4] = -change[4] * self.H[4] ** 2
        return turned


def deformed(
    gradient: FloatArray, shear: FloatArray, bulk: FloatArray, laws: Sequence[LawColumns] = ()
) -> Deformed | None:
    """State of matter; None where it is crushed or turned over, or its law has no answer.

    Parameters
    ----------
    gradient
        (5, ...) of the displacement.
    shear, bulk
        (...) moduli of the neo-Hookean solid, Pa; the first is zero where a law stands for it.
    laws
        Of layers that have their own.
    """
    F = gradient + REST.reshape(5, *(1,) * (gradient.ndim - 1))
    plane = F[0] * F[3] - F[1] * F[2]
    J = plane * F[4]
    if not (J.min() > MOST_CRUSHED and F[4].min() > 0.0):
        return None
    H = _cofactor(F)
    H[:4] /= plane
    H[4] = 1.0 / F[4]
    own = tuple(_answer(one, gradient[..., one.columns]) for one in laws)
    if not all(np.isfinite(one.energy).all() and np.isfinite(one.stress).all() for one in own):
        return None
    return Deformed(F, H, J, plane, np.einsum("i...,i...->...", F, F), shear * J ** (-2.0 / 3.0), bulk, own)


def _answer(one: LawColumns, gradient: FloatArray) -> LawState:
    with np.errstate(all="ignore"):  # no answer is a value that is not finite
        return LawState(one.columns, gradient, one.law, one.law.energy(gradient), one.law.stress(gradient))


def _cofactor(tensor: FloatArray) -> FloatArray:
    """(5, ...) cofactor in the plane; the hoop is left open."""
    return np.stack([tensor[3], -tensor[2], -tensor[1], tensor[0], tensor[4]])
