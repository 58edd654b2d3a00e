"""The exact static stiffness of an elastic layer (the P-SV solution), against which sub-layers are judged.

Between its faces a layer obeys Navier's equations, whose solutions for one wavenumber are, with zeta = k z from
the mid-plane and kappa = 3 - 4 nu,

    even:  U = A cosh + B zeta sinh,   W = (A - kappa B) sinh + B zeta cosh
    odd:   U = A sinh + B zeta cosh,   W = (A - kappa B) cosh + B zeta sinh

(as they follow on inserting them). Their tractions give the 4 x 4 stiffness between the two faces. Everything is
divided by cosh(k h / 2), so no exponential overflows at large k h.
"""

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.layers.laminate import Laminate


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
