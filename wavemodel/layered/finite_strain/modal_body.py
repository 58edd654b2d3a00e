"""The stack in modes under finite deformation: from amplitudes to forces, their tangent, and the linear stiffness.

u = -U(z) J_1(k r) and w = W(z) J_0(k r) round the tool's axis, both z and w downwards, with J_1(k R) = 0: a smooth wall
at the border, with which the modes do not couple in the linear body. Amplitudes are (N, 2 n): for each mode U of the n
nodes through the thickness, then W. Through the thickness the functions are quadratic; two Gauss points in each
sub-layer take all terms, which leaves no volumetric locking, as in the linear wave.

W = mu / 2 (J^(-2/3) tr C - 3) + K / 2 (J - 1)^2 with mu and K from the moduli at rest (J. Bonet and R. D. Wood,
Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., sections 6.5.2 and 6.5.3). Tensors have five
components: rr, rz, zr, zz and the hoop.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import j0, j1, jn_zeros

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.layered.stack.laminate import Laminate

POINTS_PER_MODE = 3.0
"""Radial quadrature points a mode: products of modes are resolved."""
PANEL = 6
EVEN = 1e-6
"""Wavenumber of the first mode times the border."""
REST = np.array([1.0, 0.0, 0.0, 1.0, 1.0])
MOST_CRUSHED = 0.05
"""A volume ratio below this is no state to go on from."""


@dataclass(frozen=True)
class DiscModes:
    """N modes on a disc and Q radial points.

    Attributes
    ----------
    wavenumber
        (N,) in rad/m; the first is next to nothing, for a deflection that is even.
    area
        (Q,) weights 2 pi r dr, m2.
    square
        (N,) integral of J_0(k r)^2 over the disc, m2.
    radial, hoop, outward, slope, level
        (Q, N) du/dr, u/r and u per U; dw/dr and w per W.
    """

    wavenumber: FloatArray
    area: FloatArray
    square: FloatArray
    radial: FloatArray
    hoop: FloatArray
    outward: FloatArray
    slope: FloatArray
    level: FloatArray


def disc_modes(border: float, limit: float) -> DiscModes:
    """Modes of a disc of radius `border` (m) up to the wavenumber `limit` (rad/m)."""
    count = int(np.ceil(limit * border / np.pi))
    k = np.concatenate([[EVEN], jn_zeros(1, count)]) / border
    point, share = np.polynomial.legendre.leggauss(PANEL)
    edges = np.linspace(0.0, border, int(np.ceil(POINTS_PER_MODE * count / PANEL)) + 1)
    width = np.diff(edges)[:, None]
    radius = (edges[:-1, None] + 0.5 * width * (point + 1.0)).ravel()
    area = 2.0 * np.pi * radius * (0.5 * width * share).ravel()
    phase = np.outer(radius, k)
    even, odd = j0(phase), j1(phase)
    hoop = -odd / radius[:, None]
    return DiscModes(k, area, np.pi * border**2 * j0(k * border) ** 2, -k * even - hoop, hoop, -odd, -k * odd, even)


@dataclass(frozen=True)
class Thickness:
    """n free nodes and Z Gauss points of a stack on a bonded base.

    Attributes
    ----------
    shape, slope
        (Z, n) of the nodes' functions, 1 and 1/m.
    weight
        (Z,) in m.
    shear, bulk
        (Z,) moduli in Pa.
    top
        (L,) nodes on the layers' top faces.
    """

    shape: FloatArray
    slope: FloatArray
    weight: FloatArray
    shear: FloatArray
    bulk: FloatArray
    top: IntArray


def thickness_of(stack: Laminate) -> Thickness:
    """Functions and points of a stack's sub-layers."""
    count = stack.sublayers
    shape, slope = np.zeros((2 * count, 2 * count + 1)), np.zeros((2 * count, 2 * count + 1))
    for s, height in enumerate(stack.thickness):
        for gauss, at in enumerate((-np.sqrt(1.0 / 3.0), np.sqrt(1.0 / 3.0))):
            nodes = slice(2 * s, 2 * s + 3)
            shape[2 * s + gauss, nodes] = [0.5 * at * (at - 1.0), 1.0 - at * at, 0.5 * at * (at + 1.0)]
            slope[2 * s + gauss, nodes] = np.array([at - 0.5, -2.0 * at, at + 0.5]) * 2.0 / height
    shear = np.repeat(stack.shear_modulus, 2)
    bulk = np.repeat(stack.lame_modulus, 2) + 2.0 / 3.0 * shear
    weight = np.repeat(0.5 * stack.thickness, 2)
    return Thickness(shape[:, :-1], slope[:, :-1], weight, shear, bulk, 2 * stack.top_of_layer)


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
