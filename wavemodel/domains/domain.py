"""Domains: a window in the plane with eigenfunctions S, lap S = -k^2 S, zero on its border; or no border at all.

Points are counted from the load's place, which need not be the middle of the window. In the laterally endless specimen
S = J_0(k r) with every k: a field with amplitudes A(k) under a unit load is int A(k) J_0(k r) k dk / (2 pi). The
specimen is endless unless the support says otherwise, so this is what a window is measured against.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import j0

from wavemodel.arrays import BoolArray, FloatArray
from wavemodel.errors import WaveError

NODES_PER_PANEL = 8
PHASE_PER_PANEL = 8.0
"""Radians that the integrand may turn within a panel of eight Gauss points (error near 1e-7)."""
MOST_NODES = 400_000
"""Wavenumbers: about 1 GB for two layers, a tool of 1/4000 of the stack's height."""


class Tables(Protocol):
    """From amplitudes to the vertices of a grid, by tables made beforehand."""

    def write(self, amplitude: FloatArray, out: FloatArray, *, add: bool) -> None:
        """Write, or add, the deflection under amplitudes (L, K) to `out` (P L, Q), m."""
        ...


class WaveDomain(Protocol):
    """Eigenfunctions with K distinct amplitudes under a load at the place."""

    @property
    def width(self) -> float:
        """How wide the window is, m."""
        ...

    @property
    def modes(self) -> int:
        """N: as many modes in one direction."""
        ...

    @property
    def place(self) -> tuple[float, float]:
        """(x, y) of the load from the middle of the window, m."""
        ...

    @property
    def reach(self) -> float:
        """From the place to the nearest point of the border, m."""
        ...

    @property
    def wavenumber(self) -> FloatArray:
        """(K,) rising, rad/m."""
        ...

    @property
    def lowest(self) -> float:
        """Wavenumber of the first mode, rad/m."""
        ...

    @property
    def pairs(self) -> int:
        """How many eigenfunctions are carried."""
        ...

    @property
    def direction(self) -> FloatArray:
        """(K,) share of each k^2 that runs along x."""
        ...

    @property
    def axis_weight(self) -> FloatArray:
        """(K,) in 1/m2: a field with amplitudes A(k) under a unit load has the value A . weight at the place."""
        ...

    def holds(self, points: FloatArray) -> BoolArray:
        """(P,) whether points (P, 2) are in the window."""
        ...

    def at(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(L, P) field of amplitudes (L, K) under a unit load, at points (P, 2)."""
        ...

    def gradient(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(P, 2) slope along x and y of the field of amplitudes (K,), at points (P, 2)."""
        ...

    def tables(self, x: FloatArray, y: FloatArray, layers: int) -> Tables:
        """Tables for vertices at all pairs of x (P,) and y (Q,).

        Raises
        ------
        WaveError
            If a vertex is outside the window.
        """
        ...


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
    """Quadrature up to wavenumber `limit` (rad/m), good for distances up to `reach` (m).

    Raises
    ------
    WaveError
        If it takes more than `MOST_NODES`: the tool is too fine beside the stack or the window.
    """
    if not limit * reach * NODES_PER_PANEL / PHASE_PER_PANEL <= MOST_NODES:
        raise WaveError(
            f"a tool so fine beside its stack or window takes {limit * reach * NODES_PER_PANEL / PHASE_PER_PANEL:.3g} "
            f"wavenumbers, which is not allowed: at most {MOST_NODES}; a wider tool or thinner layers take fewer"
        )
    panels = max(8, int(np.ceil(limit * reach / PHASE_PER_PANEL)))
    point, share = np.polynomial.legendre.leggauss(NODES_PER_PANEL)
    width = limit / panels
    middle = (np.arange(panels) + 0.5) * width
    wavenumber = (middle[:, None] + 0.5 * width * point).ravel()
    weight = np.tile(0.5 * width * share, panels) * wavenumber / (2.0 * np.pi)
    return Endless(wavenumber, weight)
