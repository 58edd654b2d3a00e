"""The stack in modes under finite deformation: from amplitudes to forces, their tangent, and the linear stiffness.

Amplitudes are (N, 2 n): for each mode U of the n nodes through the thickness, then W.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.large_press.disc_modes import DiscModes, Thickness
from wavemodel.large_press.neo_hookean import Deformed, deformed


@dataclass(frozen=True)
class ModalBody:
    """Modes in the plane and functions through the thickness.

    Attributes
    ----------
    modes, thickness
        The two.
    """

    modes: DiscModes
    thickness: Thickness

    @property
    def nodes(self) -> int:
        """Of the functions through the thickness: n."""
        return int(self.thickness.shape.shape[1])

    @cached_property
    def volume(self) -> FloatArray:
        """(Q, Z) weights of the points, m3."""
        return np.outer(self.modes.area, self.thickness.weight)

    def gradient(self, amplitude: FloatArray) -> FloatArray:
        """(5, Q, Z) displacement gradient: rr, rz, zr, zz, hoop."""
        m, t, n = self.modes, self.thickness, self.nodes
        out, up = amplitude[:, :n], amplitude[:, n:]
        across, along = out @ t.shape.T, up @ t.shape.T
        steep, deep = out @ t.slope.T, up @ t.slope.T
        return np.stack([m.radial @ across, m.outward @ steep, m.slope @ along, m.level @ deep, m.hoop @ across])

    def forces(self, stress: FloatArray) -> FloatArray:
        """(N, 2 n) internal forces of stresses (5, Q, Z), N."""
        m, t = self.modes, self.thickness
        rr, rz, zr, zz, hoop = stress * self.volume
        out = (m.radial.T @ rr + m.hoop.T @ hoop) @ t.shape + (m.outward.T @ rz) @ t.slope
        up = (m.slope.T @ zr) @ t.shape + (m.level.T @ zz) @ t.slope
        return np.concatenate([out, up], axis=1)

    def state(self, amplitude: FloatArray) -> Deformed | None:
        """Deformation at the points; None where matter is crushed or turned over."""
        return deformed(self.gradient(amplitude), self.thickness.shear, self.thickness.bulk)

    def energy(self, state: Deformed) -> float:
        """Of the whole body, J."""
        return float((self.volume * state.energy).sum())

    def force_change(self, state: Deformed, change: FloatArray) -> FloatArray:
        """(N, 2 n) change of the internal forces with the amplitudes, to first order."""
        return self.forces(state.stress_change(self.gradient(change)))

    @cached_property
    def linear_compliance(self) -> FloatArray:
        """(N, 2 n, 2 n) inverse of the stiffness at rest, mode by mode, m/N."""
        t, n, k = self.thickness, self.nodes, self.modes.wavenumber[:, None, None]
        lame = t.bulk - 2.0 / 3.0 * t.shear

        def integral(modulus: FloatArray, left: FloatArray, right: FloatArray) -> FloatArray:
            return np.asarray(np.einsum("z,zi,zj->ij", t.weight * modulus, left, right))

        out = np.empty((k.size, 2 * n, 2 * n))
        confined = lame + 2.0 * t.shear
        out[:, :n, :n] = k**2 * integral(confined, t.shape, t.shape) + integral(t.shear, t.slope, t.slope)
        out[:, n:, n:] = k**2 * integral(t.shear, t.shape, t.shape) + integral(confined, t.slope, t.slope)
        out[:, :n, n:] = k * (integral(t.shear, t.slope, t.shape) - integral(lame, t.shape, t.slope))
        out[:, n:, :n] = np.swapaxes(out[:, :n, n:], 1, 2)
        return np.asarray(np.linalg.inv(out) / self.modes.square[:, None, None])
