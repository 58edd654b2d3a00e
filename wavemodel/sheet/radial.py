"""Radial functions of the sheet: Legendre polynomials, which suit any edge.

A clamped edge, an elastic one and a tool's rim ask for different Bessel functions, each of which converges only for the
edge that it was made for (modes J_0 with their zero on the border bend there without moment). Polynomials on the free
part of the sheet converge exponentially for all of them, and the natural modes of vibration are found within them.
Under a pressure they are even (w) or odd (u, phi) about the axis.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from wavemodel.arrays import FloatArray


@dataclass(frozen=True)
class RadialFunctions:
    """N polynomials for each of u, w and phi on a <= r <= R.

    Attributes
    ----------
    inner, outer
        a and R, m; a = 0 for a whole disc.
    count
        N.
    """

    inner: float
    outer: float
    count: int

    @property
    def unknowns(self) -> int:
        """3 N: of u, w, phi in turn."""
        return 3 * self.count

    def quadrature(self) -> tuple[FloatArray, FloatArray]:
        """Radii (p,) and weights 2 pi r dr (p,), m and m2."""
        point, weight = legendre.leggauss(2 * self.count + 8)
        span = 0.5 * (self.outer - self.inner)
        radius = self.inner + span * (point + 1.0)
        return radius, 2.0 * np.pi * radius * span * weight

    def tables(self, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values and radial derivatives (2, R, N) each: of w first, then of u and phi."""
        if self.inner > 0.0:
            scale = 2.0 / (self.outer - self.inner)
            value, slope = _legendre(scale * (radius - self.inner) - 1.0, self.count)
            return np.stack([value, value]), np.stack([slope, slope]) * scale
        x = radius / self.outer
        even, rate = _legendre(2.0 * x**2 - 1.0, self.count)
        rate = rate * (4.0 * x / self.outer)[:, None]
        odd, odd_rate = even * x[:, None], rate * x[:, None] + even / self.outer
        return np.stack([even, odd]), np.stack([rate, odd_rate])

    def displacement(self, radius: FloatArray) -> FloatArray:
        """(3, R, 3N) table of u, phi and w at radii (R,)."""
        value, _ = self.tables(radius)
        n = self.count
        out = np.zeros((3, radius.size, 3 * n))
        out[0, :, :n], out[1, :, 2 * n :], out[2, :, n : 2 * n] = value[1], value[1], value[0]
        return out

    def strains(self, radius: FloatArray) -> FloatArray:
        """(5, R, 3N) table of u', u / r, w', phi, phi' at radii (R,) above zero."""
        value, slope = self.tables(radius)
        n = self.count
        out = np.zeros((5, radius.size, 3 * n))
        out[0, :, :n], out[1, :, :n] = slope[1], value[1] / radius[:, None]
        out[2, :, n : 2 * n] = slope[0]
        out[3, :, 2 * n :], out[4, :, 2 * n :] = value[1], slope[1]
        return out


def _legendre(x: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Values and derivatives (R, N) of the first N Legendre polynomials."""
    value = np.asarray(legendre.legvander(x, count - 1), dtype=np.float64)
    slope = np.zeros_like(value)
    for i, unit in enumerate(np.eye(count)):
        slope[:, i] = legendre.legval(x, legendre.legder(unit))
    return value, slope
