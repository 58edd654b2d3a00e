"""Bodies in modes under finite deformation: from amplitudes to forces, and the stack on a bonded base.

A body has N functions over the radius for u and M for w, times n functions through the thickness, z and w downwards.
What follows from them is the same for every body (`ModalBody`), be it on a base (`StackBody`) or over a hole
(`wavemodel.sheet.layered`); the energy is that of `deformation_state`.

On a base u = -U(z) J_1(k r) and w = W(z) J_0(k r) round the tool's axis, with J_1(k R) = 0: a smooth wall at the
border, with which the modes do not couple in the linear body. Amplitudes are (N, 2 n): for each mode U of the n nodes
through the thickness, then W. Through the thickness the functions are quadratic; two Gauss points in each sub-layer
take all terms, which leaves no volumetric locking, as in the linear wave.
"""

import itertools
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import j0, j1, jn_zeros

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.layered.finite_strain.deformation_state import Deformed, LawColumns, deformed
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.specimen import StrainEnergy

POINTS_PER_MODE = 3.0
"""Radial quadrature points a mode: products of modes are resolved."""
PANEL = 6
EVEN = 1e-6
"""Wavenumber of the first mode times the border."""


@dataclass(frozen=True)
class RadialTables:
    """Functions at Q radii.

    Attributes
    ----------
    radius, area
        (Q,) m, and weights 2 pi r dr, m2.
    outward, stretch, hoop
        (Q, N) u, du/dr and u/r per U.
    level, slope
        (Q, M) w and dw/dr per W.
    """

    radius: FloatArray
    area: FloatArray
    outward: FloatArray
    stretch: FloatArray
    hoop: FloatArray
    level: FloatArray
    slope: FloatArray


@dataclass(frozen=True)
class Thickness:
    """n free nodes and Z Gauss points from the upper face down.

    Attributes
    ----------
    shape, slope
        (Z, n) of the nodes' functions, 1 and 1/m.
    weight
        (Z,) in m.
    shear, bulk
        (Z,) moduli in Pa.
    faces
        (F,) nodes on the layers' faces; without the lowest, where that is bonded.
    laws
        Of layers that are not neo-Hookean, on their points.
    """

    shape: FloatArray
    slope: FloatArray
    weight: FloatArray
    shear: FloatArray
    bulk: FloatArray
    faces: IntArray
    laws: tuple[LawColumns, ...]

    @cached_property
    def neo_hookean(self) -> FloatArray:
        """(Z,) shear moduli, Pa, zero where a law stands for them."""
        out = self.shear.copy()
        for one in self.laws:
            out[one.columns] = 0.0
        return out


def law_columns(laws: Sequence[StrainEnergy | None], first: Sequence[int]) -> tuple[LawColumns, ...]:
    """Put laws of L layers on their points, which begin at `first` (L + 1,)."""
    return tuple(
        LawColumns(slice(begin, end), law)
        for law, (begin, end) in zip(laws, itertools.pairwise(first), strict=True)
        if law is not None
    )


@dataclass(frozen=True)
class ModalBody(ABC):
    """Functions over the radius and through the thickness.

    Attributes
    ----------
    radial, thickness
        The two.
    """

    radial: RadialTables
    thickness: Thickness

    @abstractmethod
    def split(self, amplitude: FloatArray) -> tuple[FloatArray, FloatArray]:
        """U (N, n) and W (M, n) of amplitudes as the body packs them."""

    @abstractmethod
    def packed(self, outward: FloatArray, down: FloatArray) -> FloatArray:
        """Put together what belongs to U (N, n) and to W (M, n): the inverse of `split`."""

    @property
    def nodes(self) -> int:
        """Of the functions through the thickness: n."""
        return int(self.thickness.shape.shape[1])

    @cached_property
    def volume(self) -> FloatArray:
        """(Q, Z) weights of the points, m3."""
        return np.outer(self.radial.area, self.thickness.weight)

    def gradient(self, amplitude: FloatArray) -> FloatArray:
        """(5, Q, Z) displacement gradient: rr, rz, zr, zz, hoop."""
        (out, down), r, t = self.split(amplitude), self.radial, self.thickness
        across, along = out @ t.shape.T, down @ t.shape.T
        steep, deep = out @ t.slope.T, down @ t.slope.T
        return np.stack([r.stretch @ across, r.outward @ steep, r.slope @ along, r.level @ deep, r.hoop @ across])

    def forces(self, stress: FloatArray) -> FloatArray:
        """Packed internal forces of stresses (5, Q, Z), N."""
        r, t = self.radial, self.thickness
        rr, rz, zr, zz, hoop = stress * self.volume
        out = (r.stretch.T @ rr + r.hoop.T @ hoop) @ t.shape + (r.outward.T @ rz) @ t.slope
        down = (r.slope.T @ zr) @ t.shape + (r.level.T @ zz) @ t.slope
        return self.packed(out, down)

    def state(self, amplitude: FloatArray) -> Deformed | None:
        """Deformation at the points; None where matter is crushed or turned over."""
        return deformed(self.gradient(amplitude), self.thickness.neo_hookean, self.thickness.bulk, self.thickness.laws)

    def energy(self, state: Deformed) -> float:
        """Of the whole body, J."""
        return float((self.volume * state.energy).sum())


@dataclass(frozen=True)
class DiscModes(RadialTables):
    """N modes on a disc, as many for w as for u, and Q radial points.

    Attributes
    ----------
    wavenumber
        (N,) in rad/m; the first is next to nothing, for a deflection that is even.
    square
        (N,) integral of J_0(k r)^2 over the disc, m2.
    """

    wavenumber: FloatArray
    square: FloatArray


def disc_modes(border: float, limit: float, points: float = POINTS_PER_MODE) -> DiscModes:
    """Modes of a disc of radius `border` (m) up to the wavenumber `limit` (rad/m), and so many radial points a mode."""
    count = int(np.ceil(limit * border / np.pi))
    k = np.concatenate([[EVEN], jn_zeros(1, count)]) / border
    point, share = np.polynomial.legendre.leggauss(PANEL)
    edges = np.linspace(0.0, border, int(np.ceil(points * count / PANEL)) + 1)
    width = np.diff(edges)[:, None]
    radius = (edges[:-1, None] + 0.5 * width * (point + 1.0)).ravel()
    area = 2.0 * np.pi * radius * (0.5 * width * share).ravel()
    phase = np.outer(radius, k)
    even, odd = j0(phase), j1(phase)
    hoop = -odd / radius[:, None]
    return DiscModes(
        radius=radius,
        area=area,
        outward=-odd,
        stretch=-k * even - hoop,
        hoop=hoop,
        level=even,
        slope=-k * odd,
        wavenumber=k,
        square=np.pi * border**2 * j0(k * border) ** 2,
    )


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
    tops = 2 * stack.top_of_layer
    laws = law_columns(stack.laws or [None] * tops.size, [*tops.tolist(), 2 * count])
    return Thickness(shape[:, :-1], slope[:, :-1], weight, shear, bulk, tops, laws)


@dataclass(frozen=True)
class StackBody(ModalBody):
    """The stack on a bonded base.

    Attributes
    ----------
    radial
        Its modes.
    """

    radial: DiscModes

    def split(self, amplitude: FloatArray) -> tuple[FloatArray, FloatArray]:
        """U and W (N, n) of amplitudes (N, 2 n)."""
        return amplitude[:, : self.nodes], amplitude[:, self.nodes :]

    def packed(self, outward: FloatArray, down: FloatArray) -> FloatArray:
        """(N, 2 n) of U and W (N, n)."""
        return np.concatenate([outward, down], axis=1)

    def force_change(self, state: Deformed, change: FloatArray) -> FloatArray:
        """(N, 2 n) change of the internal forces with the amplitudes, to first order."""
        return self.forces(state.stress_change(self.gradient(change)))

    def answer(self, forces: FloatArray) -> FloatArray:
        """(N, 2 n) linear answer of the free body to forces (N, 2 n)."""
        return np.asarray(np.einsum("nij,nj->ni", self.linear_compliance, forces))

    @cached_property
    def linear_compliance(self) -> FloatArray:
        """(N, 2 n, 2 n) inverse of the stiffness at rest, mode by mode, m/N."""
        t, n, k = self.thickness, self.nodes, self.radial.wavenumber[:, None, None]
        lame = t.bulk - 2.0 / 3.0 * t.shear

        def integral(modulus: FloatArray, left: FloatArray, right: FloatArray) -> FloatArray:
            return np.asarray(np.einsum("z,zi,zj->ij", t.weight * modulus, left, right))

        out = np.empty((k.size, 2 * n, 2 * n))
        confined = lame + 2.0 * t.shear
        out[:, :n, :n] = k**2 * integral(confined, t.shape, t.shape) + integral(t.shear, t.slope, t.slope)
        out[:, n:, n:] = k**2 * integral(t.shear, t.shape, t.shape) + integral(confined, t.slope, t.slope)
        out[:, :n, n:] = k * (integral(t.shear, t.slope, t.shape) - integral(lame, t.shape, t.slope))
        out[:, n:, :n] = np.swapaxes(out[:, :n, n:], 1, 2)
        return np.asarray(np.linalg.inv(out) / self.radial.square[:, None, None])
