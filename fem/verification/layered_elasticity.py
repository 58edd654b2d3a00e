"""Elastic layers under a disc of uniform pressure, semi-analytically: no mesh, no element.

With u_h = U(z) grad S / k and w = W(z) S, lap S = -k^2 S, z downwards, Navier's equations have in each layer the
solutions, with zeta = k (z - top),

    U = (A + B zeta) e^-zeta,    W = -(A + (3 - 4 nu) B + B zeta) e^-zeta,

and their mirror images that decay upwards from the layer's bottom. Tractions and displacements at the interfaces give
the amplitudes for each wavenumber k (at an interface without friction no shear stands in the place of one U); the
deflection on the axis is the Hankel integral

    w(z) = q a int_0^inf k W(k, z) J_1(k a) / k dk,

k W for unit pressure. On the surface k W goes to (1 - nu) / G of the first layer, whose integral is taken exactly; what
remains decays like exp(-2 k h).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import j1

from fem.arrays import BoolArray, FloatArray

NODES_PER_PANEL = 12
DECAYED = 40.0  # k h at which exp(-k h) is nothing
SMALLEST = 1e-6  # k a of the first panel


@dataclass(frozen=True)
class ElasticStack:
    """L isotropic layers from the surface down.

    Attributes
    ----------
    thickness
        (L,) in m; the last `inf` for a half-space, otherwise its lower face is bonded to a rigid base.
    youngs_modulus
        (L,) in Pa.
    poisson_ratio
        (L,).
    slipping
        Which interfaces (L - 1,) carry no shear, layers staying in touch; None: all are bonded.
    """

    thickness: FloatArray
    youngs_modulus: FloatArray
    poisson_ratio: FloatArray
    slipping: BoolArray | None = None

    @property
    def shear_modulus(self) -> FloatArray:
        """(L,) in Pa."""
        out: FloatArray = self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
        return out


def axis_deflection(stack: ElasticStack, radius: float, pressure: float) -> FloatArray:
    """Deflection of each layer's top face on the axis, (L,) in m.

    Parameters
    ----------
    stack
        The layers.
    radius, pressure
        Of the loaded disc, in m and Pa.
    """
    k, dk = _quadrature(radius, DECAYED / float(stack.thickness[np.isfinite(stack.thickness)].min(initial=radius)))
    response = surface_response(stack, k)
    limit = np.zeros(len(stack.thickness))
    limit[0] = (1.0 - stack.poisson_ratio[0]) / stack.shear_modulus[0]
    kernel = dk * j1(k * radius) / k
    out: FloatArray = pressure * radius * (limit + kernel @ (response - limit))
    return out


def surface_response(stack: ElasticStack, k: FloatArray) -> FloatArray:
    """ItemForces k W of each layer's top face (n, L) in 1/Pa under unit pressure, wavenumbers k (n,) in rad/m."""
    count, shear = len(stack.thickness), stack.shear_modulus
    endless = bool(np.isinf(stack.thickness[-1]))
    tops = [_states(stack, n, k, 0.0) for n in range(count)]
    bottoms = [_states(stack, n, k, 1.0) for n in range(count - endless)]
    matrix = np.zeros((len(k), 4 * count, 4 * count))
    matrix[:, 0:2, 0:4] = tops[0][:, 2:]
    for n in range(count - 1):
        scale = np.array([1.0, 1.0, 0.0, 0.0]) * min(shear[n], shear[n + 1]) + np.array([0.0, 0.0, 1.0, 1.0])
        rows = slice(4 * n + 2, 4 * n + 6)
        matrix[:, rows, 4 * n : 4 * n + 4] = bottoms[n] * scale[:, None]
        matrix[:, rows, 4 * n + 4 : 4 * n + 8] = -tops[n + 1] * scale[:, None]
        if stack.slipping is not None and stack.slipping[n]:
            matrix[:, 4 * n + 2, :] = 0.0
            matrix[:, 4 * n + 2, 4 * n : 4 * n + 4] = bottoms[n][:, 2]
    if endless:
        matrix[:, -2:, -2:] = np.eye(2)
    else:
        matrix[:, -2:, -4:] = bottoms[-1][:, :2] * shear[-1]
    right = np.zeros((len(k), 4 * count, 1))
    right[:, 1] = -1.0
    amplitude = np.linalg.solve(matrix, right)[..., 0].reshape(len(k), count, 4)
    return np.stack([np.einsum("nj,nj->n", tops[n][:, 1], amplitude[:, n]) for n in range(count)], axis=1)


def _states(stack: ElasticStack, layer: int, k: FloatArray, place: float) -> FloatArray:
    """States k U, k W, shear and normal traction (n, 4, 4) by amplitude, at a layer's top (`place` 0) or bottom (1).

    Amplitudes are in units of a traction over the layer's shear modulus. In an endless layer what decays upwards has
    no top to decay from: its columns are zero.
    """
    shear, nu = float(stack.shear_modulus[layer]), float(stack.poisson_ratio[layer])
    kappa, lame = 3.0 - 4.0 * nu, 2.0 * nu / (1.0 - 2.0 * nu)
    height = float(stack.thickness[layer])
    out = np.zeros((len(k), 4, 4))
    for first, mirror in ((0, 1.0), (2, -1.0)):
        if np.isinf(height) and mirror < 0.0:
            continue
        distance = place if mirror > 0.0 else 1.0 - place
        zeta = k * height * distance if distance else np.zeros_like(k)
        decay = np.exp(-zeta)
        for column, (a, b) in enumerate(((1.0, 0.0), (0.0, 1.0)), first):
            u, w = a + b * zeta, -(a + kappa * b + b * zeta)
            du, dw = b - u, -b - w
            out[:, 0, column] = u / shear
            out[:, 1, column] = mirror * w / shear
            out[:, 2, column] = mirror * (du + w)
            out[:, 3, column] = lame * (dw - u) + 2.0 * dw
            out[:, :, column] *= decay[:, None]
    return out


def _quadrature(radius: float, largest: float) -> tuple[FloatArray, FloatArray]:
    """Gauss points and weights (n,) in rad/m: panels of half a period of J_1, finer ones towards zero."""
    half_period = np.pi / radius
    fine = np.geomspace(SMALLEST / radius, half_period, 40)
    coarse = np.arange(2.0, np.ceil(largest / half_period) + 1.0) * half_period
    edges = np.concatenate(([0.0], fine, coarse))
    point, weight = np.polynomial.legendre.leggauss(NODES_PER_PANEL)
    half = 0.5 * np.diff(edges)[:, None]
    return (edges[:-1, None] + half * (1.0 + point)).ravel(), (half * weight).ravel()
