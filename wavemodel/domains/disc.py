"""The disc with Bessel modes, round the tool's axis: S = J_0(k r), zero on the border.

For axisymmetric loads it needs one mode where the rectangle needs a square of them. It has the face of `Endless`, whose
integral over k it replaces by the sum over the roots of J_0(k R) = 0; with R to infinity they are the same.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import j0, j1, jn_zeros

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError, require_positive


@dataclass(frozen=True)
class Disc:
    """Round window with N modes.

    Attributes
    ----------
    border
        R, m.
    modes
        N.

    Raises
    ------
    WaveError
        If the border is not positive or there is no mode.
    """

    border: float
    modes: int

    def __post_init__(self) -> None:
        require_positive("border", self.border, "m")
        if self.modes < 1:
            raise WaveError(f"modes = {self.modes} is not allowed: at least 1")

    @cached_property
    def wavenumber(self) -> FloatArray:
        """(N,) the k with J_0(k R) = 0, rising, rad/m."""
        return np.asarray(jn_zeros(0, self.modes) / self.border, dtype=np.float64)

    @cached_property
    def weight(self) -> FloatArray:
        """(N,) of 1 / int S^2 dA = 1 / (pi R^2 J_1(k R)^2), 1/m2: the share of each mode in a unit load on the axis."""
        return np.asarray(1.0 / (np.pi * (self.border * j1(self.wavenumber * self.border)) ** 2))

    def at_radius(self, amplitude: FloatArray, radius: FloatArray) -> FloatArray:
        """Field at radii: amplitudes (..., N) under a unit load on the axis, and radii (P,), m, to (..., P).

        Raises
        ------
        WaveError
            If a radius is outside the disc.
        """
        place = np.asarray(radius, dtype=np.float64)
        if not np.all((place >= 0.0) & (place <= self.border)):
            raise WaveError(f"disc: a radius outside 0 to {self.border * 1e3:g} mm is not allowed")
        return np.asarray((amplitude * self.weight) @ j0(np.outer(self.wavenumber, place)))
