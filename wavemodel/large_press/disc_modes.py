"""Bessel modes round the tool's axis, and the quadratic functions through the thickness, with their quadrature.

u = -U(z) J_1(k r) and w = W(z) J_0(k r), both z and w downwards, with J_1(k R) = 0: a smooth wall at the border, with
which the modes do not couple in the linear body. Two Gauss points in each sub-layer take all terms, which leaves no
volumetric locking, as in the linear wave.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import j0, j1, jn_zeros

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.layers.laminate import Laminate

POINTS_PER_MODE = 3.0
"""Radial quadrature points a mode: products of modes are resolved."""
PANEL = 6
EVEN = 1e-6
"""Wavenumber of the first mode times the border."""


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
