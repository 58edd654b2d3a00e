"""Stiffness and mass of a sub-layer: quadratic through the thickness, and the exact one that it is judged by.

For an in-plane eigenfunction S with lap S = -k^2 S the displacement is u_h = U(z) grad S / k, w = W(z) S, both
z and w downwards. The strain energy per unit of int S^2 dA is

    1/2 int [ lam (W' - k U)^2 + 2 G (k^2 U^2 + W'^2) + G (U' + k W)^2 ] dz ,

to which an in-plane stress sigma before the press adds 1/2 int sigma k^2 (U^2 + W^2) dz (Biot's incremental
deformations, moduli unchanged). Three nodes (top, bottom, middle) carry U and W. The terms in lam take two Gauss
points, which leaves no volumetric locking as Poisson's ratio nears one half. Unknowns of a sub-layer: U_top, W_top,
U_bottom, W_bottom, U_mid, W_mid.

Exactly, a layer obeys Navier's equations between its faces, whose solutions for one wavenumber (P-SV) are, with
zeta = k z from the mid-plane and kappa = 3 - 4 nu,

    even:  U = A cosh + B zeta sinh,   W = (A - kappa B) sinh + B zeta cosh
    odd:   U = A sinh + B zeta cosh,   W = (A - kappa B) cosh + B zeta sinh

(as they follow on inserting them). Their tractions give the 4 x 4 stiffness between the two faces. Everything is
divided by cosh(k h / 2), so no exponential overflows at large k h.
"""

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.layered.stack.laminate import Laminate

SLOPE_SLOPE = np.array([[7.0, 1.0, -8.0], [1.0, 7.0, -8.0], [-8.0, -8.0, 16.0]]) / 3.0
"""h int N'_i N'_j dz, exact."""
SHAPE_SHAPE = np.array([[4.0, -1.0, 2.0], [-1.0, 4.0, 2.0], [2.0, 2.0, 16.0]]) / 30.0
"""int N_i N_j dz / h, exact."""
SHAPE_SHAPE_REDUCED = np.array([[2.0, -1.0, 2.0], [-1.0, 2.0, 2.0], [2.0, 2.0, 8.0]]) / 18.0
"""int N_i N_j dz / h by two Gauss points."""
SHAPE_SLOPE = np.array([[-3.0, -1.0, 4.0], [1.0, 3.0, -4.0], [-4.0, 4.0, 0.0]]) / 6.0
"""int N_i N'_j dz; of third degree, so two Gauss points are exact."""


def quadratic_stiffness(wavenumber: FloatArray, laminate: Laminate) -> FloatArray:
    """K(k) of every sub-layer.

    Parameters
    ----------
    wavenumber
        (n,) k in rad/m.
    laminate
        S sub-layers.

    Returns
    -------
    ndarray (n, S, 6, 6)
        In Pa/m: force per area of the eigenfunction and per metre.
    """
    k = wavenumber[:, None, None, None]
    h, shear, lame = (
        values[:, None, None] for values in (laminate.thickness, laminate.shear_modulus, laminate.lame_modulus)
    )
    slope = SLOPE_SLOPE / h
    out = np.empty((wavenumber.size, laminate.sublayers, 6, 6))
    out[..., 0::2, 0::2] = k**2 * (h * (lame * SHAPE_SHAPE_REDUCED + 2.0 * shear * SHAPE_SHAPE)) + shear * slope
    out[..., 1::2, 1::2] = (lame + 2.0 * shear) * slope + k**2 * (shear * h * SHAPE_SHAPE)
    coupling = k * (shear * SHAPE_SLOPE.T - lame * SHAPE_SLOPE)
    out[..., 0::2, 1::2] = coupling
    out[..., 1::2, 0::2] = np.swapaxes(coupling, -1, -2)
    if laminate.tension is not None:
        stressed = k**2 * (laminate.tension[..., None, None] * h * SHAPE_SHAPE)
        out[..., 0::2, 0::2] += stressed
        out[..., 1::2, 1::2] += stressed
    return out


def consistent_mass(laminate: Laminate) -> FloatArray:
    """Consistent mass of every sub-layer, the same for every k.

    Returns
    -------
    ndarray (S, 6, 6)
        In kg/m2.
    """
    out = np.zeros((laminate.sublayers, 6, 6))
    block = (laminate.density * laminate.thickness)[:, None, None] * SHAPE_SHAPE
    out[:, 0::2, 0::2] = block
    out[:, 1::2, 1::2] = block
    return out


def exact_stiffness(wavenumber: FloatArray, laminate: Laminate) -> FloatArray:
    """Exact static K(k) of every sub-layer.

    Parameters
    ----------
    wavenumber
        (n,) k in rad/m, above zero.
    laminate
        S sub-layers.

    Returns
    -------
    ndarray (n, S, 4, 4)
        Between U_top, W_top, U_bottom, W_bottom, in Pa/m.
    """
    k = wavenumber[:, None]
    half = 0.5 * k * laminate.thickness
    tanh = np.tanh(half)
    sech2 = 1.0 / np.cosh(np.minimum(half, 300.0)) ** 2
    lame, shear = laminate.lame_modulus, laminate.shear_modulus
    kappa = (lame + 3.0 * shear) / (lame + shear)
    even, odd = _families(half, tanh, sech2, kappa)
    scale = (k * shear)[..., None, None]
    return _both_faces(scale * even, scale * odd)


def _families(
    half: FloatArray, tanh: FloatArray, sech2: FloatArray, kappa: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Traction (shear, normal) on the lower face per (U, W) there, over G k, for the even and odd solutions."""
    even_det = half * sech2 - kappa * tanh
    odd_det = -half * sech2 - kappa * tanh
    even = np.empty((*half.shape, 2, 2))
    even[..., 0, 0] = -(1.0 + kappa) * tanh**2 / even_det
    even[..., 0, 1] = even[..., 1, 0] = ((1.0 - kappa) * tanh + 2.0 * half * sech2) / even_det
    even[..., 1, 1] = -(1.0 + kappa) / even_det
    odd = np.empty_like(even)
    odd[..., 0, 0] = -(1.0 + kappa) / odd_det
    odd[..., 0, 1] = odd[..., 1, 0] = ((1.0 - kappa) * tanh - 2.0 * half * sech2) / odd_det
    odd[..., 1, 1] = -(1.0 + kappa) * tanh**2 / odd_det
    return even, odd


def _both_faces(even: FloatArray, odd: FloatArray) -> FloatArray:
    """4 x 4 stiffness of upper and lower face from the two families.

    The even family has U alike and W opposite on the two faces, the odd one the other way round.
    """
    mirror = np.array([1.0, -1.0])
    same = 0.5 * (even + odd)
    across = 0.5 * (even - odd) * mirror
    out = np.empty((*even.shape[:-2], 4, 4))
    out[..., 2:, 2:] = same
    out[..., 2:, :2] = across
    out[..., :2, 2:] = np.swapaxes(across, -1, -2)
    out[..., :2, :2] = same * np.outer(mirror, mirror)
    return out
