"""State of deformation at any points: energy, stress and its change, of a neo-Hookean solid.

W = mu / 2 (J^(-2/3) tr C - 3) + K / 2 (J - 1)^2 with mu and K from the moduli at rest (J. Bonet and R. D. Wood,
Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., sections 6.5.2 and 6.5.3). Tensors have five
components: rr, rz, zr, zz and the hoop.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray

REST = np.array([1.0, 0.0, 0.0, 1.0, 1.0])
MOST_CRUSHED = 0.05
"""A volume ratio below this is no state to go on from."""


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
        (...) mu J^(-2/3) and K, Pa.
    """

    F: FloatArray
    H: FloatArray
    J: FloatArray
    plane: FloatArray
    first: FloatArray
    scale: FloatArray
    bulk: FloatArray

    @property
    def energy(self) -> FloatArray:
        """(...) W in J/m3."""
        shear = 0.5 * self.scale * (self.first - 3.0 * self.J ** (2.0 / 3.0))
        return np.asarray(shear + 0.5 * self.bulk * (self.J - 1.0) ** 2)

    @property
    def stress(self) -> FloatArray:
        """(5, ...) first Piola-Kirchhoff stress, Pa."""
        return np.asarray(self.scale * self.F + self._along_inverse * self.H)

    @property
    def _along_inverse(self) -> FloatArray:
        return np.asarray(self.bulk * (self.J - 1.0) * self.J - self.scale * self.first / 3.0)

    def stress_change(self, change: FloatArray) -> FloatArray:
        """(5, ...) change of stress with a change (5, ...) of F, to first order."""
        volume = np.einsum("i...,i...->...", self.H, change)
        stretch = np.einsum("i...,i...->...", self.F, change)
        along = self.scale * (2.0 / 9.0 * self.first * volume - 2.0 / 3.0 * stretch)
        along += self.bulk * (2.0 * self.J - 1.0) * self.J * volume
        out = self.scale * (change - (2.0 / 3.0) * volume * self.F)
        out += along * self.H
        out += self._along_inverse * self._inverse_change(change)
        return np.asarray(out)

    def _inverse_change(self, change: FloatArray) -> FloatArray:
        """(5, ...) change of H."""
        turned = _cofactor(change)
        plane = np.einsum("i...,i...->...", _cofactor(self.F)[:4], change[:4])
        turned[:4] = (turned[:4] - self.H[:4] * plane) / self.plane
        turned[4] = -change[4] * self.H[4] ** 2
        return turned


def deformed(gradient: FloatArray, shear: FloatArray, bulk: FloatArray) -> Deformed | None:
    """State from a displacement gradient (5, ...) and moduli (...), Pa; None where matter is crushed or turned over."""
    F = gradient + REST.reshape(5, *(1,) * (gradient.ndim - 1))
    plane = F[0] * F[3] - F[1] * F[2]
    J = plane * F[4]
    if not (J.min() > MOST_CRUSHED and F[4].min() > 0.0):
        return None
    H = _cofactor(F)
    H[:4] /= plane
    H[4] = 1.0 / F[4]
    return Deformed(F, H, J, plane, np.einsum("i...,i...->...", F, F), shear * J ** (-2.0 / 3.0), bulk)


def _cofactor(tensor: FloatArray) -> FloatArray:
    """(5, ...) cofactor in the plane; the hoop is left open."""
    return np.stack([tensor[3], -tensor[2], -tensor[1], tensor[0], tensor[4]])
