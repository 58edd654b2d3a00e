"""Uniform pressure on a disc: the transform is 2 J_1(k a) / (k a)."""

from dataclasses import dataclass

import numpy as np
from scipy.special import hyp2f1, j1

from wavemodel.arrays import FloatArray
from wavemodel.loads.half_space import HalfSpace
from wavemodel.loads.traction import Traction


@dataclass(frozen=True)
class UniformPressure:
    """The one function of a uniform pressure (a `TractionBasis` with J = 1).

    Attributes
    ----------
    radius
        Of the disc, m.
    """

    radius: float

    @property
    def net_force(self) -> FloatArray:
        """(1,) of one."""
        return np.ones(1)

    def transform(self, wavenumber: FloatArray) -> FloatArray:
        """(n, 1, 2): nothing along U."""
        x = wavenumber * self.radius
        out = np.zeros((x.size, 1, 2))
        out[:, 0, 1] = 2.0 * j1(x) / x
        return out

    def half_space_deflection(self, body: HalfSpace, radius: FloatArray) -> FloatArray:
        """(R, 1) normal displacement at radii (R,), m/N: the integral of Weber and Schafheitlin."""
        rho = radius / self.radius
        out = np.empty_like(rho)
        inside = rho <= 1.0
        out[inside] = 2.0 * hyp2f1(0.5, -0.5, 1.0, rho[inside] ** 2)
        out[~inside] = hyp2f1(0.5, 0.5, 2.0, rho[~inside] ** -2.0) / rho[~inside]
        return (body.normal * out / (2.0 * np.pi * self.radius))[:, None]

    def half_space_flexibility(self, body: HalfSpace) -> FloatArray:
        """(1, 1) mean displacement under the pressure, m/N."""
        return np.array([[body.normal * 16.0 / (3.0 * np.pi) / (2.0 * np.pi * self.radius)]])


def uniform_pressure(radius: float) -> Traction:
    """Uniform pressure of unit force on a disc of the given radius, m."""
    return Traction(UniformPressure(radius), np.ones(1))
