"""The laterally endless specimen: S = J_0(k r) with every k, and its quadrature.

A field with amplitudes A(k) under a unit load is int A(k) J_0(k r) k dk / (2 pi). The specimen is endless unless
the support says otherwise, so this is what a window of finite width is measured against.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import j0

from wavemodel.arrays import FloatArray

NODES_PER_PANEL = 8
PHASE_PER_PANEL = 8.0
"""Radians that the integrand may turn within a panel of eight Gauss points (error near 1e-7)."""


@dataclass(frozen=True)
class Endless:
    """Quadrature over the wavenumbers.

    Attributes
    ----------
    wavenumber
        (q,) in rad/m, above zero, rising.
    weight
        (q,) k dk / (2 pi) in 1/m2.
    """

    wavenumber: FloatArray
    weight: FloatArray

    def at_radius(self, amplitude: FloatArray, radius: FloatArray) -> FloatArray:
        """Field at radii: amplitudes (..., q) and radii (R,) to (..., R)."""
        field: FloatArray = (amplitude * self.weight) @ j0(np.outer(self.wavenumber, radius))
        return field


def endless(limit: float, reach: float) -> Endless:
    """Quadrature up to wavenumber `limit` (rad/m), good for distances up to `reach` (m)."""
    panels = max(8, int(np.ceil(limit * reach / PHASE_PER_PANEL)))
    point, share = np.polynomial.legendre.leggauss(NODES_PER_PANEL)
    width = limit / panels
    middle = (np.arange(panels) + 0.5) * width
    wavenumber = (middle[:, None] + 0.5 * width * point).ravel()
    weight = np.tile(0.5 * width * share, panels) * wavenumber / (2.0 * np.pi)
    return Endless(wavenumber, weight)
